"""Lay a page out as a PDF, in a process of its own.

It reads two lines from standard input: the page as JSON, which it lays out at once, and the file with what is known
only later: where to write to, and what to attach. WeasyPrint cannot be interrupted, and it prints and warns as it is
loaded; a process can be ended, and its output is kept apart. This module imports nothing of `assess`, so that
it starts at once.
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
    """Lay out the page that is sent; of none, print the version of WeasyPrint.

    The file holds where to write to as ``path``, WeasyPrint's ``variant``, the ``time`` of the document in ISO 8601,
    and ``attachments``: name, kind, relationship, description and data (base64) of each.
    """
    page = json.loads(sys.stdin.buffer.readline() or b"null")
    try:
        import weasyprint
    except (ImportError, OSError) as error:
        sys.stderr.write(f"\n{str(error).splitlines()[0]}")
        sys.exit(MISSING)
    if page is None:
        print(weasyprint.__version__)  # noqa: T201 - the answer of this process
        return
    gc.disable()  # the process ends with the file: looking for memory to give back takes a tenth of its time
    document = open_page(page["html"], page["fonts"]).render()
    rest = sys.stdin.buffer.readline().decode().strip()
    if not rest:
        return  # the caller has ended
    try:
        job = json.loads(Path(rest).read_text(encoding="utf-8"))
        moment = datetime.datetime.fromisoformat(job["time"])
        document.metadata.created = document.metadata.modified = f"{moment:%Y-%m-%dT%H:%M:%SZ}"
        attachments = [
            weasyprint.Attachment(  # a data: URI has the media type of the job, not one that is guessed
                url=f"data:{one['kind']};base64,{one['data']}", url_fetcher=_closed_fetcher({}), name=one["name"],
                description=one["description"], relationship=one["relationship"], created=moment, modified=moment,
            )
            for one in job["attachments"]
        ]  # fmt: skip
        document.write_pdf(job["path"], pdf_variant=job["variant"], pdf_tags=True, attachments=attachments)
    except OSError as error:
        sys.stderr.write(f"\n{json.dumps([error.errno, error.strerror or str(error)])}")
        sys.exit(UNWRITTEN)


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
