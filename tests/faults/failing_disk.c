/* Writes below HOOKEAN_FAULT_FOLDER fail when the shared counters of HOOKEAN_FAULT_CONTROL say so.
 * Preloaded into a server by tests/faults/disk.py; never part of an installation. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/types.h>
#include <unistd.h>

/* calls until one fails (0: none will); whether all later ones fail too; errno; how many have failed; seen */
struct control { int64_t until, sticky, error, failed, seen; };

static struct control *shared(void) {
    static struct control *found;
    if (!found) {
        const char *path = getenv("HOOKEAN_FAULT_CONTROL");
        int (*plain_open)(const char *, int, ...) = dlsym(RTLD_NEXT, "open");
        int file = path ? plain_open(path, O_RDWR | O_CLOEXEC) : -1;
        if (file < 0) return NULL;
        void *map = mmap(NULL, sizeof *found, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
        close(file);
        if (map == MAP_FAILED) return NULL;
        found = map;
    }
    return found;
}

static int fails(struct control *control) {
    __atomic_add_fetch(&control->seen, 1, __ATOMIC_SEQ_CST);
    int64_t until = __atomic_load_n(&control->until, __ATOMIC_SEQ_CST);
    while (until > 0)
        if (__atomic_compare_exchange_n(&control->until, &until, until - 1, 0, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST)) {
            if (until != 1) return 0;
            if (control->sticky) __atomic_store_n(&control->until, -1, __ATOMIC_SEQ_CST);
            until = -1;
            break;
        }
    if (until == 0) return 0;
    __atomic_add_fetch(&control->failed, 1, __ATOMIC_SEQ_CST);
    errno = (int)control->error;
    return 1;
}

static int below(const char *path) {
    const char *folder = getenv("HOOKEAN_FAULT_FOLDER");
    return folder && path && strncmp(path, folder, strlen(folder)) == 0;
}

static int path_fails(const char *path) {
    struct control *control = shared();
    return control && control->until != 0 && below(path) && fails(control);
}

static int file_fails(int file) {
    char name[64], path[4096];
    struct control *control = shared();
    if (!control || control->until == 0) return 0;
    snprintf(name, sizeof name, "/proc/self/fd/%d", file);
    ssize_t size = readlink(name, path, sizeof path - 1);
    if (size <= 0) return 0;
    path[size] = 0;
    return below(path) && fails(control);
}

#define REAL(type, name, ...) \
    static type (*real)(__VA_ARGS__); \
    if (!real) real = (type (*)(__VA_ARGS__))dlsym(RTLD_NEXT, name)

ssize_t write(int f, const void *d, size_t n) {
    REAL(ssize_t, "write", int, const void *, size_t);
    return file_fails(f) ? -1 : real(f, d, n);
}
ssize_t pwrite(int f, const void *d, size_t n, off_t o) {
    REAL(ssize_t, "pwrite", int, const void *, size_t, off_t);
    return file_fails(f) ? -1 : real(f, d, n, o);
}
ssize_t pwrite64(int f, const void *d, size_t n, off64_t o) {
    REAL(ssize_t, "pwrite64", int, const void *, size_t, off64_t);
    return file_fails(f) ? -1 : real(f, d, n, o);
}
int fsync(int f) {
    REAL(int, "fsync", int);
    return file_fails(f) ? -1 : real(f);
}
int fdatasync(int f) {
    REAL(int, "fdatasync", int);
    return file_fails(f) ? -1 : real(f);
}
int ftruncate(int f, off_t n) {
    REAL(int, "ftruncate", int, off_t);
    return file_fails(f) ? -1 : real(f, n);
}
int ftruncate64(int f, off64_t n) {
    REAL(int, "ftruncate64", int, off64_t);
    return file_fails(f) ? -1 : real(f, n);
}
int rename(const char *a, const char *b) {
    REAL(int, "rename", const char *, const char *);
    return path_fails(b) ? -1 : real(a, b);
}
int mkdir(const char *path, mode_t mode) {
    REAL(int, "mkdir", const char *, mode_t);
    return path_fails(path) ? -1 : real(path, mode);
}
