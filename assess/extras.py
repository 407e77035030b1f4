"""How to install an extra: in one place, as the name `assess` on PyPI is another project's."""

from assess.i18n import Text, fill


def say_install(extra: str) -> Text:
    """Return the line that tells how to install one extra of pyproject.toml."""
    return fill(
        "Install it from the folder of the source code of assess: python -m pip install '.[{extra}]', or with pipx: "
        "pipx install --force '.[{extra}]'",
        extra=extra,
    )
