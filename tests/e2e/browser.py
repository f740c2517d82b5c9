"""Pages of pirsim in headless Chromium, for the tests that open one."""
import re
import shutil
import subprocess
import sys

COMMON = ["--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
          "--disable-component-update", "--disable-sync", "--enable-logging=stderr", "--virtual-time-budget=20000"]


def chromium_or_skip():
    """The program; the test ends as skipped where there is none."""
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if not found:
        print("SKIPPED: no Chromium")
        sys.exit(77)
    return found


def without_scripts(text):
    return re.sub(r"<script.*?</script>", "", text, flags=re.DOTALL)


def check_fetches_nothing(page):
    markup = without_scripts(page.read_text(encoding="utf-8"))
    fetched = re.findall(r'(?:src|href)="(?!#|data:)[^"]*"|@import|url\(', markup)
    assert not fetched, f"{page.name} fetches {fetched}"


def opened(chromium, page, folder, size, *flags, address=""):
    """The page's markup once its scripts have run, which must leave nothing on the console. folder: for a profile;
    address: what follows the page's, "#t=12"."""
    command = [chromium, *COMMON, *flags, f"--user-data-dir={folder / 'profile'}", f"--window-size={size}", "--dump-dom",
               page.as_uri() + address]
    result = subprocess.run(command, capture_output=True, text=True, timeout=240)
    console = [line for line in result.stderr.splitlines() if "CONSOLE" in line]
    assert not console, f"{page.name} on the console: {console}"
    return result.stdout
