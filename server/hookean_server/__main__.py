"""`python -m hookean_server [port]`."""

import sys

from hookean_server.lifecycle.main import serve

if __name__ == "__main__":
    sys.exit(serve(port=int(sys.argv[1]) if len(sys.argv) > 1 else 8765))
