"""The service that computes, on this machine: status, start, stop, and the studio in the browser.

The Engine and all components that need the service start it by themselves where they can.
"""

from hookean_client import canvas_server

found = canvas_server.stand(ghenv, start_, stop_, studio_)
status = found.status
url = found.url
version = found.version
sessions = found.sessions
