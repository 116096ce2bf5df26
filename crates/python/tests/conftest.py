"""What holds for all tests."""

import _thread
import signal
import threading
import time

import pytest

# A shell has its background jobs ignore Ctrl-C, and tests are about it.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def interrupted():
    """Does something that takes a minute, presses Ctrl-C after a second, and expects it to stop within three more."""

    def within(work):
        def press():
            time.sleep(1)
            _thread.interrupt_main()

        other = threading.Thread(target=press)
        other.start()
        began = time.monotonic()
        with pytest.raises(KeyboardInterrupt):
            work()
        other.join()
        assert time.monotonic() - began < 4

    return within
