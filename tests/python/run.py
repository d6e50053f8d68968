"""Runs a file of tests with pytest: run.py FILE..."""

import sys

if __name__ == "__main__":  # pools that spawn read this file again
    try:
        import pytest
    except ImportError as missing:
        print(f"SKIPPED: {missing}: needs python3-pytest (.ci/test-packages.txt)")
        sys.exit(77)
    sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", *sys.argv[1:]]))
