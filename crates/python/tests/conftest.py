"""What holds for all tests."""

import signal

# A shell has its background jobs ignore Ctrl-C, and tests are about it.
signal.signal(signal.SIGINT, signal.default_int_handler)
