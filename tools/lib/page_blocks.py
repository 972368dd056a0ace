"""The blocks of a page that a tool writes: what stands between two markers, which are comments of the page."""

import re


class MarkerMissing(SystemExit):
    """There is not exactly one block between the markers. A tool that does not catch it ends with the message."""


def with_block(page, begin, end, text):
    """The page with the text between the markers, as paragraphs of its own, whatever was there."""
    page, count = re.subn(f"{re.escape(begin)}.*?{re.escape(end)}", lambda _: f"{begin}\n\n{text.strip()}\n\n{end}", page,
                          flags=re.DOTALL)
    if count != 1:
        raise MarkerMissing(f"not exactly one pair of markers '{begin}' and '{end}'")
    return page


def write_blocks(file, blocks):
    """Puts each text between its markers in the file: `blocks` are begin, end and text. All or none are written."""
    page = file.read_text(encoding="utf-8")
    try:
        for block in blocks:
            page = with_block(page, *block)
    except MarkerMissing as missing:
        raise MarkerMissing(f"{file}: {missing}") from None
    file.write_text(page, encoding="utf-8")
