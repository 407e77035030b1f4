"""``python -m assess``, and the command ``assess``: signals are answered before anything else is imported."""

import _signal  # type: ignore[import-not-found]  # what `signal` is made of: that one takes milliseconds to import


def main() -> None:
    """Run the command line."""
    if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, _signal.SIG_DFL)  # until signals are answered, Ctrl-C just ends the process
    from assess.cli.interrupts import answer_signals

    answer_signals()
    from assess.cli.app import main as run

    run()


if __name__ == "__main__":
    main()
