"""Blocks as HTML: every text escaped, words that are too long for a column given places to break at."""

from collections.abc import Iterable
from urllib.parse import quote

from markupsafe import escape

from assess.i18n import gettext as _
from assess.report import blocks
from assess.report.equations import split_line
from assess.report.figures.math_figures import INK, draw_math, write_letters
from assess.report.templates import LONGEST_WORD, break_words

_TAGS = frozenset(("strong", "em", "sub", "sup"))


class HtmlWriter:
    """Writes blocks for a screen or for print.

    On a screen each cell holds the heading of its column, as rows are cards on a phone, and equations are parts of the
    page which share the outlines of their letters (`write_letters`); in print each is a file of its own.
    """

    def __init__(self, *, for_print: bool) -> None:
        self.for_print = for_print
        self.letters: dict[str, str] = {}

    def section(self, one: blocks.Section) -> str:
        """Return a section with its heading; on a screen one of the kind "fold" opens when its heading is chosen."""
        title = f'<h2 id="{one.id}-heading">{escape(one.heading)}</h2>\n' if one.heading else ""
        inside = f"{title}{self.write_blocks(one.blocks)}"
        if "fold" in one.kind.split() and not self.for_print:
            inside = f"<details>\n<summary>{title}</summary>\n{self.write_blocks(one.blocks)}</details>\n"
        return f"<section{_attributes(id=one.id, kind=one.kind)}>\n{inside}</section>\n"

    def write_blocks(self, found: Iterable[blocks.Block]) -> str:
        """Return blocks, one below the other."""
        return "".join(f"{self._block(one)}\n" for one in found)

    def _block(self, one: blocks.Block) -> str:
        match one:
            case blocks.Paragraph(words, kind):
                return f"<p{_attributes(kind=kind)}>{self.words(words)}</p>"
            case blocks.Heading(words, level):
                return f"<h{level}>{self.words(words)}</h{level}>"
            case blocks.Table():
                return self._table(one)
            case blocks.Bullets(items, kind):
                lines = "".join(f"<li>{self.words(item)}</li>\n" for item in items)
                return f"<ul{_attributes(kind=kind)}>{lines}</ul>"
            case blocks.Terms(items):
                terms = "".join(f"<dt>{self.words(term)}</dt><dd>{self.words(text)}</dd>\n" for term, text in items)
                return f'<dl class="marks">\n{terms}</dl>'
            case blocks.Tiles(tiles):
                counts = "".join(
                    f'<div class="tile {one.kind}"><span class="tile-name">{escape(one.name)}</span>'
                    f'<span class="tile-number">{escape(one.number)}</span>'
                    f'<span class="tile-note">{escape(one.note)}</span></div>\n'
                    for one in tiles
                )
                return f'<div class="tiles">\n{counts}</div>'
            case blocks.Figure(image, caption, kind, legend):
                caption_ = f"\n<figcaption>{self.words(caption)}</figcaption>" if caption else ""
                inside = self.write_blocks(legend)
                focus = self._name_scroller(_("Figure")) if kind else ""  # on a phone it scrolls sideways
                return f"<figure{_attributes(kind=kind)}{focus}>{self._image(image)}{inside}{caption_}</figure>"
            case blocks.Listing(head, lines):
                rows = "\n".join(self.words(line) for line in lines)
                return f'<pre class="listing"><b>{escape(head)}</b>\n{rows}\n</pre>'
            case blocks.Equations(lines, is_whole):
                rows = "".join(f"<p>{self.words(line)}</p>" for line in lines)
                return f'<div class="equations{" whole" if is_whole else ""}">{rows}</div>'
            case blocks.Title(words, short, status, conditions):
                running = {"short": short, "status": status, "conditions": conditions, "page": _("Page"), "of": _("of")}
                data = "".join(f' data-{name}="{escape(text)}"' for name, text in running.items())
                return f"<h1{data}>{self.words(words)}</h1>"
            case blocks.Contents(heading, lines, after):
                rows = ""
                for line, inner in lines:  # what leads nowhere is a note after those below the line
                    links = "".join(f"<li>{self.words(one)}</li>\n" for one in inner if not isinstance(one, str))
                    notes = "".join(f'<p class="small">{self.words(one)}</p>' for one in inner if isinstance(one, str))
                    below = f"\n<ol>\n{links}</ol>" if links else ""
                    rows += f"<li>{self.words(line)}{below}{notes}</li>\n"
                note = f'<p class="small">{self.words(after)}</p>\n' if after else ""
                return (
                    f'<nav class="contents" id="contents" aria-label="{escape(heading)}">\n'
                    f'<h2 class="plain">{escape(heading)}</h2>\n<ol>\n{rows}</ol>\n{note}</nav>'
                )
            case blocks.Box(inside, kind, tag, id_, label):
                attributes = _attributes(id=id_, kind=kind) + (self._name_scroller(label, "region") if label else "")
                return f"<{tag}{attributes}>\n{self.write_blocks(inside)}</{tag}>"

    def _name_scroller(self, name: str, role: str = "") -> str:
        """Return the attributes of what scrolls on a screen: it is reached by the keyboard, and says what it is."""
        part = f' role="{role}"' if role else ""
        return "" if self.for_print else f'{part} tabindex="0" aria-label="{escape(name)}"'

    # ------------------------------------------------------------ tables

    def _table(self, one: blocks.Table) -> str:
        labels = [escape(" ".join(blocks.plain_words(column.heading).split())) for column in one.columns]
        has_labels = one.is_cards and not self.for_print
        parts = [f"<table{_attributes(id=one.id, kind=one.kind)}>\n"]
        parts += [f"<caption>{self.words(one.caption)}</caption>\n"] if one.caption else []
        parts += ["<colgroup>", *(f"<col{_attributes(kind=each.width)}>" for each in one.columns), "</colgroup>\n"]
        if any(labels):
            parts.append("<thead><tr>")
            for column in one.columns:
                kind = _attributes(kind=_kind(column, column.kind))
                parts.append(f'<th scope="col"{kind}>{self.words(column.heading)}</th>')
            parts.append("</tr></thead>\n")
        for rows in one.groups:
            parts.append("<tbody>\n")
            for row in rows:
                data = "".join(f' data-{name}="{escape(value)}"' for name, value in row.data.items())
                parts.append(f"<tr{_attributes(id=row.id, kind=row.kind)}{data}>")
                for at, cell in row.place_cells():
                    words = self.words(cell.words, is_broken=one.is_named)
                    span = f' colspan="{cell.columns}"' if cell.columns > 1 else ""
                    if cell.is_head:
                        scope = "rowgroup" if row.kind == "part" else "row"
                        parts.append(f'<th scope="{scope}"{span}>{words}</th>')
                    else:
                        kind = _kind(one.columns[at], cell.kind) if cell.columns == 1 else cell.kind
                        sort = f' data-value="{escape(cell.sort)}"' if cell.sort is not None else ""
                        label = f' data-label="{labels[at]}"' if labels[at] and has_labels else ""
                        parts.append(f"<td{_attributes(kind=kind)}{span}{sort}{label}>{words}</td>")
                parts.append("</tr>\n")
            parts.append("</tbody>\n")
        return "".join((*parts, "</table>"))

    # ------------------------------------------------------------ on a line

    def words(self, words: blocks.Words, *, is_broken: bool = False) -> str:
        """Return what stands on a line, if `is_broken` with places to break long words at."""
        if isinstance(words, str):
            return str(break_words(words) if is_broken and len(words) > LONGEST_WORD else escape(words))
        return "".join(
            self.words(one, is_broken=is_broken) if isinstance(one, str) else self._inline(one)
            for one in blocks.list_words(words)
        )

    def _inline(self, one: blocks.Span | blocks.Image | blocks.Equation) -> str:
        match one:
            case blocks.Span(_, "break"):
                return "<br>"
            case blocks.Span(words, kind, href, title):
                inside = self.words(words)
                if kind in _TAGS:
                    inside = f"<{kind}>{inside}</{kind}>"
                title_ = f' title="{escape(title)}"' if title else ""
                class_ = _attributes(kind="" if kind in _TAGS else kind)
                if href:
                    return f'<a{class_} href="{escape(href)}"{title_}>{inside}</a>'
                return f"<span{class_}{title_}>{inside}</span>" if class_ else inside
            case blocks.Image():
                return self._image(one)
            case blocks.Equation(text):
                return "".join(
                    self._math(piece.tex, piece.text) if piece.tex else self.words(blocks.lower_indices(piece.text))
                    for piece in split_line(text)
                )

    def _image(self, image: blocks.Image) -> str:
        if image.is_drawn:
            return image.source
        return f'<img{_attributes(kind=image.kind)} src="{escape(image.source)}" alt="{escape(image.alternative)}">'

    def _math(self, tex: str, text: str) -> str:
        """Return an equation as a picture, of which the plain text is the alternative (WCAG 2.2, 1.1.1)."""
        drawn = draw_math(tex)
        if self.for_print:
            head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{drawn.view}" fill="{INK}">'
            data = quote(f"{head}{write_letters(drawn.letters)}{drawn.placed}</svg>", safe=" /:=,;()-")
            return (
                f'<img class="math" src="data:image/svg+xml,{escape(data)}" alt="{escape(text)}" '
                f'style="{escape(drawn.style)}">'
            )
        self.letters |= drawn.letters
        return (
            f'<svg class="math" role="img" aria-label="{escape(text)}" viewBox="{drawn.view}" '
            f'style="{escape(drawn.style)}">{drawn.placed}</svg>'
        )


def _attributes(*, id: str = "", kind: str = "") -> str:  # noqa: A002 - as HTML calls it
    return (f' id="{escape(id)}"' if id else "") + (f' class="{escape(kind)}"' if kind else "")


def _kind(column: blocks.Column, kind: str) -> str:
    return f"num {kind}".strip() if column.is_number else kind
