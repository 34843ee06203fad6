"""What all tests need before they start."""

import signal

# A shell that starts the tests in the background has Ctrl-C ignored, and so would every process
# that the tests start and interrupt.
signal.signal(signal.SIGINT, signal.default_int_handler)
