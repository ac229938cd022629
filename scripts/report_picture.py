"""Make docs/report.png: a picture of the report that `make study` writes.

Needs Chromium on the PATH (Debian's package `chromium`). Example:

    make picture
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

REPORT = Path("studies/classic/report.html")
PICTURE = Path("docs/report.png")
SIZE = "900,900"


def main() -> None:
    """Take the picture; exit with an error if a requirement is missing."""
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    if not browser:
        sys.exit("report_picture: needs chromium or google-chrome on the PATH")
    if not REPORT.exists():
        sys.exit(f"report_picture: {REPORT} is missing; run `make study` first")
    with tempfile.TemporaryDirectory() as profile:
        subprocess.run(
            [
                browser,
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-background-networking",
                "--disable-component-update",
                "--disable-sync",
                "--no-first-run",
                "--hide-scrollbars",
                f"--user-data-dir={profile}",
                f"--window-size={SIZE}",
                f"--screenshot={PICTURE.resolve()}",
                REPORT.resolve().as_uri(),
            ],
            check=True,
            timeout=120,
        )
    print(PICTURE)


if __name__ == "__main__":
    main()
