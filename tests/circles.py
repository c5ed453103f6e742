"""Circles of imports, for the tests of both languages."""


def circle(asks):
    """Modules that import each other in a circle, from the imports of each module."""
    # settle modules that import only settled ones; the rest is in a circle or imports from one
    settled, left = set(), {*asks, *(found for all_found in asks.values() for found in all_found)}
    while free := {module for module in left if asks.get(module, set()) <= settled}:
        settled |= free
        left -= free
    while outer := {module for module in left if not any(module in asks.get(other, ()) for other in left)}:
        left -= outer
    return left
