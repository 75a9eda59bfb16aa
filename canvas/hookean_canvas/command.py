"""`hookean canvas`: Grasshopper's files on the command line."""

from __future__ import annotations

import typer

app = typer.Typer(
    name="hookean canvas",
    help="Grasshopper without Rhino: build components, look into archives, run and import definitions.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


@app.callback()
def _options() -> None:
    pass
