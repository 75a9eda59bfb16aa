"""`hookean token`: prints the token that authenticates programs and browsers."""

from __future__ import annotations

import os
import sys
from typing import Annotated

import typer

from hookean.commands.command import new
from hookean_server.http.tokens import VARIABLE
from hookean_server.lifecycle.command import PORT, refuse
from hookean_server.lifecycle.discovery import Distrusted, ask, check, find, folder

app = new()


@app.command()
def token(
    url: Annotated[
        bool, typer.Option("--url", help="Print the address to open in a browser, with the token in it")
    ] = False,
    header: Annotated[bool, typer.Option("--header", help="Print the header, for curl -H @-")] = False,
    renew: Annotated[
        bool, typer.Option("--renew", help="Replace the token of the running service, which logs all clients out")
    ] = False,
) -> None:
    """Print the token of the service: HOOKEAN_TOKEN if it is set, else that of the running service.

    Every start of the service makes another token. --renew replaces it while the service runs: the old token, the
    log-ins of all browsers and open connections become invalid.
    """
    raise typer.Exit(run(url, header, renew))


def run(url: bool = False, header: bool = False, renew: bool = False) -> int:
    """Print the token in HOOKEAN_TOKEN, else that of the running server; the exit code: 0, or 1 for neither.

    `url`: print the address with the token instead; browsers do not send the part after the #. `header`: print the
    header that a program sends. `renew`: replace the token of the running server first, which logs all clients out.
    """
    place = folder()
    try:
        check(place)
    except Distrusted as error:
        return refuse(str(error))
    given = "" if renew else os.environ.get(VARIABLE, "")
    found = find(place) if url or not given else None
    if found is None and not given:
        print("No hookean server is running; start one with: hookean serve", file=sys.stderr)
        return 1
    if renew and found is not None:
        if ask(found, "POST", "/v1/token") is None or (found := find(place)) is None:
            print("The token was not replaced: the server could not write its file, or has ended.", file=sys.stderr)
            return 1
        print("All clients are logged out; programs and pages need this token.", file=sys.stderr)
    known = given or (found.token if found is not None else "")
    at = found.url if found is not None else f"http://127.0.0.1:{PORT}"
    print(f"{at}/#t={known}" if url else f"Authorization: Bearer {known}" if header else known)
    return 0
