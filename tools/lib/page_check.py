"""What the checks of pages share: the command line, and screenshots."""

import argparse
import json
import shutil
import sys
import tempfile
from pathlib import Path

from .browser import Browser, faults_of_events


def photograph(browser, url, shots, widths):
    """Leaves a picture of the whole page of each width, light and dark; yields a fault if it is wider than its window."""
    if browser.takes_screenshots:
        shots.mkdir(parents=True, exist_ok=True)
    for width in widths:
        browser.load(url, width)
        for scheme in ("light", "dark"):
            browser.screenshot(shots / f"page-{width}-{scheme}.png", width, scheme)
        wide = browser.value("document.documentElement.scrollWidth")
        if wide > width:
            yield f"the page is {wide} pixels wide in a window of {width}"


def main(description, check, data_name="report.json"):
    """`check(browser, url, report, shots)` yields the faults of a page beside its data. Returns the exit status."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=Path, metavar="DIR", help="a report")
    parser.add_argument("-o", "--output", type=Path, metavar="SHOTS", help="default: DIR/screenshots")
    parser.add_argument("--no-screenshots", action="store_true", help="leave none, in half the time")
    arguments = parser.parse_args()
    program = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if not program:
        print("there is no browser; on Debian: apt-get install chromium", file=sys.stderr)
        return 77
    page = arguments.directory.resolve() / "index.html"
    data = arguments.directory / data_name
    for file in (page, data):
        if not file.is_file():
            parser.error(f"there is no {file}")
    shots = arguments.output or arguments.directory / "screenshots"
    faults = []
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(program, profile, takes_screenshots=not arguments.no_screenshots)
        try:
            for fault in check(browser, page.as_uri(), json.loads(data.read_text()), shots):
                faults.append(fault)
        except RuntimeError as error:
            faults.append(str(error))
        finally:
            browser.close()
    faults += faults_of_events(browser.events, page.as_uri())
    for fault in dict.fromkeys(faults):
        print(f"{arguments.directory}: {fault}", file=sys.stderr)
    if not faults:
        where = "" if arguments.no_screenshots else f"; screenshots are in {shots}"
        print(f"{arguments.directory}: the page is sound{where}")
    return 1 if faults else 0
