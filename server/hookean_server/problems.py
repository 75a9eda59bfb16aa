"""Problems: every answer that is not a success, as `application/problem+json` (RFC 9457)."""

from __future__ import annotations

import errno
import json
from collections.abc import Iterable
from typing import Any

from hookean.errors import InputError

MEDIA_TYPE = "application/problem+json"
MOST = 20  # faults listed in one answer
LONGEST = 600  # characters of one sentence
LONGEST_POINTER = 200

CATALOGUE: dict[str, tuple[int, str, str]] = {
    "bad-request": (400, "Malformed request", "Follow the API's description at /v1/openapi.json."),
    "unauthorized": (
        401,
        "Token missing or wrong",
        "Send the header Authorization: Bearer with the token of this start of the service; the command "
        "`hookean token` prints it.",
    ),
    "forbidden-host": (
        403,
        "Host name not allowed",
        "Address the service as 127.0.0.1, localhost or [::1] with its port; a web page that reaches it under "
        "another name is refused.",
    ),
    "forbidden-origin": (
        403,
        "Origin not allowed",
        "Pages of another origin may not send requests that change or compute something.",
    ),
    "read-only": (
        403,
        "Read-only link",
        "A read-only link reads its session: status, scene, topology, anchors, state, surface, view and frames. Ask "
        "the person who shared it to change something.",
    ),
    "not-found": (404, "Not found", "The API's description at /v1/openapi.json lists every address."),
    "method-not-allowed": (405, "Method not allowed", "The header Allow lists the supported methods."),
    "slow-body": (408, "Timeout while reading the body", "Send the body without long pauses."),
    "key-taken": (409, "Key already in use", "Choose another key, or let the service choose one."),
    "stale-revision": (
        412,
        "Edited by another client",
        "The header ETag has the current revision: read the session again and send the edit with this If-Match.",
    ),
    "too-large": (413, "Too large", "Send less, for example arrays as buffers instead of lists, or a coarser model."),
    "unsupported-media": (
        415,
        "Unsupported media type",
        "Send JSON as application/json and files as multipart/form-data, without compression.",
    ),
    "invalid-scene": (
        422,
        "Invalid scene",
        "Each entry of errors points at one fault and names the allowed values.",
    ),
    "invalid-input": (
        422,
        "Invalid input",
        "Each entry of errors points at one fault and names the allowed values.",
    ),
    "headers-too-large": (431, "Headers too large", "Send fewer or shorter headers, or a shorter address."),
    "session-limit": (
        429,
        "Session limit reached",
        "Delete one with DELETE /v1/sessions/{key}, or retry after the seconds in the header Retry-After.",
    ),
    "job-limit": (
        429,
        "Job limit reached",
        "Cancel one with DELETE /v1/jobs/{id}, or retry after the seconds in the header Retry-After.",
    ),
    "key-reused": (
        422,
        "Idempotency-Key already used by another request",
        "A key identifies one request and its body. Use another key for another body.",
    ),
    "internal": (500, "Internal error", "This is a defect of the service; its log has the details."),
    "worker-lost": (
        500,
        "The worker process ended",
        "It has been replaced; other requests are not affected. If this happens again, report the input.",
    ),
    "busy": (503, "All workers are busy", "Retry after the seconds in the header Retry-After."),
    "shutting-down": (503, "The service is shutting down", "Start it again and repeat the request."),
    "not-stored": (
        507,
        "Could not be stored",
        "Nothing was changed. Free disk space, or repair the disk, and repeat the request.",
    ),
    "over-quota": (
        507,
        "Store quota reached",
        "Nothing was changed. Delete sessions or jobs that are no longer needed, or raise HOOKEAN_QUOTA (MiB).",
    ),
    "out-of-time": (
        504,
        "Timeout",
        "The work was stopped. Give a smaller model, a looser tolerance or a shorter time_limit.",
    ),
}
"""Slug: status, title and advice. `type` is `/problems/<slug>`, a page with this text."""


class Problem(Exception):
    """An answer that is not a success; raised anywhere, sent by the outermost middleware."""

    def __init__(
        self,
        slug: str,
        detail: str,
        errors: Iterable[tuple[str, str]] = (),
        headers: dict[str, str] | None = None,
    ) -> None:
        super().__init__(slug, detail)
        self.slug = slug
        self.detail = _cut(detail, LONGEST)
        self.errors = [(_cut(p, LONGEST_POINTER), _cut(d, LONGEST)) for p, d in errors]
        self.headers = headers or {}

    def to_wire(self) -> dict[str, Any]:
        """Its form in the head of a message between processes."""
        return {"problem": self.slug, "detail": self.detail, "errors": self.errors, "headers": self.headers}

    @classmethod
    def from_wire(cls, head: dict[str, Any]) -> Problem | None:
        """The problem in the head of a message, or None."""
        if "problem" not in head:
            return None
        return cls(head["problem"], head["detail"], [(p, d) for p, d in head["errors"]], head["headers"])

    @property
    def status(self) -> int:
        """The HTTP status."""
        return CATALOGUE[self.slug][0]

    def body(self, instance: str, *, hops: bool = False) -> bytes:
        """The problem document; `instance` names the request it is about. Hops takes errors as plain sentences."""
        status, title, _ = CATALOGUE[self.slug]
        document: dict[str, Any] = {
            "type": f"/problems/{self.slug}",
            "title": title,
            "status": status,
            "detail": self.detail,
            "instance": instance,
        }
        if hops:
            document.update(values=[], errors=[self.detail], warnings=[], Inputs=[], Outputs=[])
        elif self.errors:
            document["errors"] = [{"pointer": p, "detail": d} for p, d in self.errors[:MOST]]
        return json.dumps(document).encode()


def is_function(path: str) -> bool:
    """Whether an address is a name at the root, as Hops' functions have; clients that ask for one read as Hops does."""
    return path.startswith("/") and "/" not in path[1:] and path not in ("/", "/docs", "/metrics", "/v1")


def not_stored(error: BaseException) -> Problem:
    """The problem of a full or broken disk."""
    full = "full" in str(error) or getattr(error, "errno", None) in (errno.ENOSPC, errno.EDQUOT)
    why = "the disk is full" if full else "the disk or its file system refused the write"
    return Problem(
        "not-stored",
        f"Nothing was changed: {why}. Free space or repair it, and repeat the request; nothing else is lost.",
    )


def faulty(slug: str, faults: list[InputError]) -> Problem:
    """The problem of an input with faults; a pointer `/` stands for the whole of it."""
    first = faults[0]
    more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
    detail = f"{first.pointer}: {_cut(first.sentence, 300)}{more}"
    return Problem(
        slug, detail, [(f.pointer if f.pointer.startswith("/") else f"/{f.pointer}", f.sentence) for f in faults]
    )


def page(slug: str) -> str:
    """The text of `/problems/<slug>`."""
    status, title, advice = CATALOGUE[slug]
    return f"{title} ({status})\n\n{advice}\n"


def _cut(text: str, longest: int) -> str:
    return text if len(text) <= longest else text[: longest - 3] + "..."
