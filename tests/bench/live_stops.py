"""Times from SIGINT or SIGTERM to the end of build/release/echocine live: live_stops.py SCENE [TIMES]

The signal comes at a random instant of each state: without a request, while a picture at rest is rendered, while another heart
is computed (parametric hearts only), while a loop is encoded, while the scene is saved, and before the page is served.
"""

import http.client
import json
import os
import random
import signal
import statistics
import subprocess
import sys
import threading
import time

PROGRAM = os.environ.get("ECHOCINE", os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../build/release/echocine"))


def ask(link, path, body, started):
    host, token = link.split("/")[2], link.split("=")[1]
    connection = http.client.HTTPConnection(host, timeout=60)
    try:
        connection.request("POST", path, json.dumps(body), {"Content-Type": "application/json", "Echocine-Token": token})
        started.set()
        return connection.getresponse().status
    except OSError:
        return None  # the program has ended
    except http.client.HTTPException:
        return None
    finally:
        connection.close()


def stopped(scene, path, bodies, longest_s, number):
    """Seconds from the signal to the end, and the exit code."""
    begun = time.monotonic()
    server = subprocess.Popen([PROGRAM, "live", scene, "--no-browser", "--quiet"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    threads = []
    if path is not None:
        link = server.stdout.readline().strip()
        for one in bodies:
            started = threading.Event()
            threads.append(threading.Thread(target=ask, args=(link, path, one, started)))
            threads[-1].start()
            started.wait()
        begun = time.monotonic()
    time.sleep(max(0.0, begun + random.Random(number).uniform(0, longest_s) - time.monotonic()))
    sent = time.monotonic()
    server.send_signal(signal.SIGINT if number % 2 else signal.SIGTERM)
    code = server.wait()
    took = time.monotonic() - sent
    for thread in threads:
        thread.join()
    server.stdout.close()
    return took, code


def main(scene, times=30):
    states = {
        "idle": ("/picture", [], 0.1),
        "pictures at rest": ("/picture", [{"frame": 7, "keys": {"signal.gain_db": 1}}], 1.5),
        "other speckle": ("/picture", [{"frame": 7, "keys": {"speckle.seed": 8}}], 1.5),
        "moving pictures": ("/picture", [{"frame": i, "effort": "moving"} for i in range(4)], 0.1),
        "another heart": ("/heart", [{"dials": {"ef": 0.4, "edv": 140}}], 1.5),
        "a loop as MP4": ("/loop", [{"format": "mp4"}], 4),
        "a loop as GIF": ("/loop", [{"format": "gif"}], 4),
        "a loop as WebP": ("/loop", [{"format": "webp"}], 4),
        "truth": ("/truth", [{"frame": 3, "layers": ["labels", "wall"]}], 1.5),
        "cost of effects": ("/cost", [{}], 1.5),
        "before the page": (None, [], 1.5),
    }
    for name, (path, bodies, longest_s) in states.items():
        spent, codes = [], set()
        for number in range(int(times)):
            took, code = stopped(scene, path, bodies, longest_s, number)
            spent.append(took)
            codes.add(code)
        spent.sort()
        print(f"{name}: median {1e3 * statistics.median(spent):.0f} ms, p95 {1e3 * spent[int(0.95 * len(spent))]:.0f} ms,"
              f" most {1e3 * spent[-1]:.0f} ms; exit codes {sorted(codes)}; load {os.getloadavg()[0]:.1f}", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
