"""Lay the page out as a PDF, in a process of its own: ``python -c "from ... import main; main()" < job > answer``.

WeasyPrint cannot be interrupted, and it prints and warns as it is loaded; a process can be ended, and its output
belongs to nobody else. This module imports nothing of `assess`, so that it starts at once.
"""

import datetime
import gc
import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

MISSING = 3
"""Exit code where WeasyPrint or one of its native libraries is missing; standard error ends with the reason."""
UNWRITTEN = 4
"""Exit code where the file cannot be written; standard error ends with number and text of the error, in JSON."""


def main() -> None:
    """Read a job from standard input and lay it out; of an empty one, print the version of WeasyPrint."""
    text = sys.stdin.buffer.read()
    try:
        import weasyprint
    except (ImportError, OSError) as error:
        sys.stderr.write(f"\n{str(error).splitlines()[0]}")
        sys.exit(MISSING)
    if text:
        gc.disable()  # the process ends with the file: looking for memory to give back takes a tenth of its time
        try:
            lay_out(json.loads(text))
        except OSError as error:
            sys.stderr.write(f"\n{json.dumps([error.errno, error.strerror or str(error)])}")
            sys.exit(UNWRITTEN)
    else:
        print(weasyprint.__version__)  # noqa: T201 - the answer of this process


def lay_out(job: dict[str, Any]) -> None:
    """Write a PDF.

    `job` holds the page as ``html``, the files of its ``fonts`` by address, where to write to as ``path``, WeasyPrint's
    ``variant``, the ``time`` of the document in ISO 8601, and ``attachments``: name, kind, relationship, description
    and data (base64) of each.
    """
    moment = datetime.datetime.fromisoformat(job["time"])
    document = open_page(job["html"], job["fonts"]).render()
    document.metadata.created = document.metadata.modified = f"{moment:%Y-%m-%dT%H:%M:%SZ}"
    document.write_pdf(
        job["path"],
        pdf_variant=job["variant"],
        pdf_tags=True,
        attachments=[_attachment(one, moment) for one in job["attachments"]],
    )


def open_page(html: str, fonts: Mapping[str, str]) -> Any:
    """Return a page as `weasyprint.HTML`, which names the files of its `fonts` by their addresses."""
    import weasyprint

    return weasyprint.HTML(string=html, url_fetcher=_closed_fetcher(fonts))


def _closed_fetcher(fonts: Mapping[str, str]) -> Any:
    """Return a fetcher that opens data: URIs and these fonts: nothing else of the network or the disk is read."""
    from weasyprint.urls import URLFetcher, URLFetcherResponse

    class Fetcher(URLFetcher):  # type: ignore[misc]  # WeasyPrint has no types
        def fetch(self, url: str, headers: Mapping[str, str] | None = None) -> Any:
            if url in fonts:
                return URLFetcherResponse(url, Path(fonts[url]).read_bytes(), {"Content-Type": "font/ttf"})
            return super().fetch(url, headers)

    return Fetcher(allowed_protocols={"data"}, allow_redirects=False, fail_on_errors=True)


def _attachment(file: dict[str, str], moment: datetime.datetime) -> Any:
    """Return an attachment; as a data: URI, so that it has the media type of the job, not one that is guessed."""
    from weasyprint import Attachment

    return Attachment(
        url=f"data:{file['kind']};base64,{file['data']}",
        url_fetcher=_closed_fetcher({}),
        name=file["name"],
        description=file["description"],
        relationship=file["relationship"],
        created=moment,
        modified=moment,
    )
