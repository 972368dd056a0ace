"""Tables of Markdown, their figures, and the markers of what is generated."""

NOT_KNOWN = "–"
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def figure(value, digits=3):
    """So many significant digits, without an exponent; None is a dash."""
    if value is None:
        return NOT_KNOWN
    if value == 0:
        return "0"
    # Rounded first, since 9.996 has one digit less behind the point than it seems to.
    value = float(f"{value:.{digits - 1}e}")
    exponent = int(f"{value:e}".split("e")[1])
    return f"{value:,.{max(0, digits - 1 - exponent)}f}"


def count_text(value):
    """Powers of ten from 10,000 on as such, others with commas."""
    digits = str(value)
    if value >= 10_000 and digits.strip("0") == "1":
        return "10" + str(len(digits) - 1).translate(SUPERSCRIPTS)
    return f"{value:,}"


def exponent_text(exponent):
    """Two digits behind the point, and no minus before a zero."""
    return NOT_KNOWN if exponent is None else f"{round(exponent, 2) + 0.0:.2f}".replace("-", "−")


def table(head, rows, words=(0,)):
    """A table whose columns are aligned to the right, but for those of `words`."""
    rules = ("---" if column in words else "---:" for column in range(len(head)))
    lines = ["| " + " | ".join(head) + " |", "|" + "|".join(rules) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def markers(block):
    """Between which the block stands on the page."""
    return f"<!-- made by tools/lab/bench: {block} -->", f"<!-- end of what tools/lab/bench made: {block} -->"
