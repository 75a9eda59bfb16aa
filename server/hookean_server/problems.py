"""Problems: every answer that is no success, as `application/problem+json` (RFC 9457)."""

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
    "bad-request": (400, "The request cannot be understood", "Send it as the API's description says."),
    "unauthorized": (
        401,
        "The token is missing or wrong",
        "Send the header Authorization: Bearer with the token of this start of the service; the command "
        "`hookean token` prints it.",
    ),
    "forbidden-host": (
        403,
        "This host name is not served",
        "Address the service as 127.0.0.1, localhost or [::1] with its port; a web page that reaches it under "
        "another name is refused.",
    ),
    "forbidden-origin": (
        403,
        "Other sites may not do this",
        "Requests that change or compute something are refused from pages of another origin.",
    ),
    "not-found": (404, "There is nothing here", "The API's description at /v1/openapi.json lists every address."),
    "method-not-allowed": (405, "This address does not take that method", "The header Allow lists those it takes."),
    "slow-body": (408, "The body did not arrive in time", "Send the body without long pauses."),
    "key-taken": (409, "There is one of this key already", "Choose another key, or leave it to the service."),
    "stale-revision": (
        412,
        "Somebody else has edited it",
        "The header ETag has the current revision: read the session again and send the edit with If-Match for that.",
    ),
    "too-large": (413, "Too large", "Send less, for example arrays as buffers instead of lists, or a coarser model."),
    "unsupported-media": (
        415,
        "This kind of body is not taken",
        "Send JSON as application/json and files as multipart/form-data, neither compressed.",
    ),
    "invalid-scene": (
        422,
        "The scene has faults",
        "Each entry of errors points at one fault and says what is allowed there.",
    ),
    "invalid-input": (
        422,
        "The input has faults",
        "Each entry of errors points at one fault and says what is allowed.",
    ),
    "headers-too-large": (431, "The headers are too large", "Send fewer or shorter headers, or a shorter address."),
    "session-limit": (
        429,
        "There are as many sessions as are kept",
        "Delete one with DELETE /v1/sessions/{key}, or come back after the seconds in the header Retry-After.",
    ),
    "job-limit": (
        429,
        "There are as many jobs as are taken",
        "Cancel one with DELETE /v1/jobs/{id}, or come back after the seconds in the header Retry-After.",
    ),
    "key-reused": (
        422,
        "This Idempotency-Key belongs to another request",
        "A key stands for one request and its body. Take another key for another body.",
    ),
    "internal": (500, "The service failed", "This is a defect of the service; its log tells more."),
    "worker-lost": (
        500,
        "The process that worked on this ended",
        "It has been replaced and other requests go on. If it happens again with the same input, report the input.",
    ),
    "busy": (503, "All workers are busy", "Come back after the seconds in the header Retry-After."),
    "shutting-down": (503, "The service is shutting down", "Start it again and repeat the request."),
    "not-stored": (
        507,
        "It could not be stored",
        "Nothing was changed. Make room on the disk, or mend it, and repeat the request.",
    ),
    "over-quota": (
        507,
        "The store may not take more",
        "Nothing was changed. Delete sessions or jobs that are no longer needed, or raise HOOKEAN_QUOTA (MiB).",
    ),
    "out-of-time": (
        504,
        "Not done in time",
        "The work was stopped. Give a smaller model, a looser tolerance or a shorter time_limit.",
    ),
}
"""Slug: status, title and what to do. `type` is `/problems/<slug>`, which the service answers with these words."""


class Problem(Exception):
    """An answer that is no success; raised anywhere, sent by the outermost middleware."""

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
        """What stands for it in the head of a message between processes."""
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
    """Whether an address is a name at the root, as Hops' functions have; whoever asks for one reads as Hops does."""
    return path.startswith("/") and "/" not in path[1:] and path not in ("/", "/docs", "/metrics", "/v1")


def not_stored(error: BaseException) -> Problem:
    """What a disk that is full or broken gives."""
    full = "full" in str(error) or getattr(error, "errno", None) in (errno.ENOSPC, errno.EDQUOT)
    why = "the disk is full" if full else "the disk or its file system refused the write"
    return Problem(
        "not-stored", f"Nothing was changed: {why}. Make room or mend it and repeat the request; nothing else is lost."
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
    """What `/problems/<slug>` says."""
    status, title, advice = CATALOGUE[slug]
    return f"{title} ({status})\n\n{advice}\n"


def _cut(text: str, longest: int) -> str:
    return text if len(text) <= longest else text[: longest - 3] + "..."
