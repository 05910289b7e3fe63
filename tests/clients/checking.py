"""What the checks of other programs share: failures, told as they come, and equality."""

import math

failures = []


def expect(good, *words):
    """Notes a failure unless `good`."""
    if not good:
        failures.append(" ".join(str(word) for word in words))
        print("FAIL", failures[-1], flush=True)


def close(a, b, tolerance=1e-5):
    """Equal but for rounding; NaN equals nothing."""
    return math.isclose(a, b, rel_tol=tolerance, abs_tol=tolerance)
