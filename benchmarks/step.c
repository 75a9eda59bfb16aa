/* One loop of explicit time steps over springs, as a C programmer writes it: scalar, any topology, an edge at a time. */
#include <math.h>
#include <string.h>

void steps(long n, long m, long count, double *x, double *v, double *f, const int *e, const double *k, const double *l0,
           const double *load, const double *im)
{
    for (long s = 0; s < count; s++) {
        memcpy(f, load, 24 * n);
        for (long i = 0; i < m; i++) {
            int a = e[2 * i] * 3, b = e[2 * i + 1] * 3;
            double dx = x[b] - x[a], dy = x[b + 1] - x[a + 1], dz = x[b + 2] - x[a + 2];
            double w = k[i] * (1 - l0[i] / sqrt(dx * dx + dy * dy + dz * dz));
            dx *= w; dy *= w; dz *= w;
            f[a] += dx; f[a + 1] += dy; f[a + 2] += dz;
            f[b] -= dx; f[b + 1] -= dy; f[b + 2] -= dz;
        }
        for (long i = 0; i < n; i++)
            for (int c = 0; c < 3; c++) {
                v[3 * i + c] = 0.99 * v[3 * i + c] + f[3 * i + c] * im[i];
                x[3 * i + c] += v[3 * i + c];
            }
    }
}
