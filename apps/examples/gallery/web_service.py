# A picture from a web service
# A server of Python's standard library answers a request with the bytes of a PNG file, which never touch its disk.
import http.server
import os
import pathlib
import threading
import urllib.request

import halflit

knot = halflit.Scene.load(os.environ["HALFLIT_EXAMPLES"] + "/knot.glb")


class Pictures(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        body = knot.render((480, 360), azimuth=float(self.path.rpartition("=")[2]), time_limit=10).encode("png")
        self.send_response(200)
        self.end_headers()
        self.wfile.write(body)


with http.server.HTTPServer(("127.0.0.1", 0), Pictures) as server:
    threading.Thread(target=server.handle_request).start()  # one request, for this example
    with urllib.request.urlopen(f"http://127.0.0.1:{server.server_port}/picture?azimuth=-30") as answer:
        pathlib.Path("answer.png").write_bytes(answer.read())
