"""Makes the page of the add-on's manual links of docs/blender.md: headings, tables, paragraphs."""

import html
import re

_STYLE = """
body { font: 16px/1.5 sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em; color: #222 }
table { border-collapse: collapse } td, th { border: 1px solid #bbb; padding: .3em .6em }
td, th { text-align: left; vertical-align: top } h1 { margin-top: 2em; font-size: 1.4em }
"""
_PICTURE = re.compile(r"!\[[^\]]*\]\([^)]*\)")
# Other pages and places do not come with the add-on.
_LINK = re.compile(r"\[([^\]]*)\]\((#?)([^)]*)\)")
_CODE = re.compile(r"`([^`]+)`")
_STRONG = re.compile(r"\*\*([^*]+)\*\*")
_EMPHASIS = re.compile(r"\*([^*]+)\*")


def page(text: str) -> str:
    """A whole page of Markdown as the documents here are written."""
    blocks = re.split(r"\n{2,}|(?<=\n)(?=#)", _PICTURE.sub("", text))
    body = "\n".join(_block(each.strip()) for each in blocks if each.strip())
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>Orbflow</title>'
        f"<style>{_STYLE}</style></head><body>\n{body}\n</body></html>\n"
    )


def anchor(title: str) -> str:
    """The anchor of a heading, as GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def _block(text: str) -> str:
    if text.startswith("#"):
        title, _, rest = text.partition("\n")
        title = title.lstrip("# ")
        heading = f'<h1 id="{anchor(title)}">{_inline(title)}</h1>'
        return heading + ("\n" + _block(rest.strip()) if rest.strip() else "")
    if text.startswith("|"):
        return _table(text.split("\n"))
    if text.startswith("- "):
        items = "".join(f"<li>{_inline(each)}</li>" for each in text[2:].split("\n- "))
        return f"<ul>{items}</ul>"
    return f"<p>{_inline(text)}</p>"


def _table(lines: list[str]) -> str:
    rows = [[each.strip() for each in line.strip("|").split("|")] for line in lines]
    head = "".join(f"<th>{_inline(each)}</th>" for each in rows[0])
    body = ("".join(f"<td>{_inline(each)}</td>" for each in row) for row in rows[2:])
    return f"<table><tr>{head}</tr>" + "".join(f"<tr>{row}</tr>" for row in body) + "</table>"


def _inline(text: str) -> str:
    text = html.escape(text, quote=False)
    text = _CODE.sub(r"<code>\1</code>", text)
    text = _LINK.sub(lambda it: f'<a href="#{it[3]}">{it[1]}</a>' if it[2] else it[1], text)
    return _EMPHASIS.sub(r"<em>\1</em>", _STRONG.sub(r"<strong>\1</strong>", text))
