#!/bin/sh
# setup.sh WHAT: makes a virtual environment ($VENV, or .venv) and installs WHAT ('.' or '.[dev]') into it, editable.
# Where this is Debian or Ubuntu and we may install packages, the system libraries of the PDF are installed as well;
# elsewhere they are named. Without them everything works but the PDF.
set -eu

PYTHON=${PYTHON:-python3}
VENV=${VENV:-.venv}
LIBRARIES="libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0"

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; elif sudo -n true 2>/dev/null; then sudo -n "$@"; else return 1; fi
}

install_packages() {
    command -v apt-get >/dev/null 2>&1 || return 1
    as_root sh -c "apt-get update -q >/dev/null && DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $*" >/dev/null
}

"$PYTHON" - <<'CHECK' || exit 1
import sys
if sys.version_info < (3, 11):
    sys.exit("assess needs Python 3.11 or later; this is %s. Set PYTHON=/path/to/python3.11." % sys.version.split()[0])
CHECK

if ! "$PYTHON" -c "import ensurepip, venv" 2>/dev/null; then
    version=$("$PYTHON" -c "import sys; print('%d.%d' % sys.version_info[:2])")
    echo "Installing the system package python3-venv ..."
    install_packages python3-venv || install_packages "python$version-venv" || {
        echo "Python has no venv module. Install it: apt install python3-venv" >&2
        exit 1
    }
fi

[ -x "$VENV/bin/python" ] || "$PYTHON" -m venv "$VENV"
pip() { "$VENV/bin/python" -m pip install --quiet --disable-pip-version-check "$@"; }
# uv takes a third of pip's time; where it cannot reach the packages, as behind some proxies, pip does.
{ pip uv && "$VENV/bin/python" -m uv pip install --quiet --python "$VENV/bin/python" -e "$1"; } 2>/dev/null || pip -e "$1"

works() { "$VENV"/bin/python -c "import weasyprint" >/dev/null 2>&1; }
if ! works; then
    echo "Installing the system libraries of the PDF: $LIBRARIES ..."
    install_packages "$LIBRARIES" || true
    works || echo "The PDF needs system libraries: apt install $LIBRARIES (Debian, Ubuntu). All else works." >&2
fi
