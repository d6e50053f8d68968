"""Times of the live page of build/release/echocine in headless Chromium: live_moves.py SCENE [MOVES [KEY=VALUE ...]]

Each move is a key press. Its time ends when the canvas has the picture of the new pose. Memory is that of the program.
"""

import json
import os
import signal
import statistics
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../browser"))
import browser  # noqa: E402

MOVES = """
const [count, keys, done] = arguments, state = page.parts.live, times = [], made = [];
Object.assign(state.keys, keys);
state.held = true;  // as with a pointer that is down
let begun = 0, version = 0, left = count;
const press = () => {
  begun = performance.now();
  document.body.dispatchEvent(new KeyboardEvent("keydown", { key: left % 2 ? "ArrowRight" : "ArrowUp", bubbles: true }));
  version = state.version;
};
const look = () => {
  if (state.shown && state.shown.version >= version) {
    times.push(performance.now() - begun);
    made.push(state.shown.ms);
    if (--left <= 0) return done([times, made]);
    if (left === count / 2) document.body.dispatchEvent(new KeyboardEvent("keydown", { key: "0", bubbles: true }));
    press();
  }
  setTimeout(look, 0);
};
press();
look();
"""


def memory_mb(pid):
    with open(f"/proc/{pid}/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS")) / 1024


def main(scene, moves=200, *keys):
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../build/release/echocine")
    server = subprocess.Popen([program, "live", scene, "--no-browser", "--quiet"], stdout=subprocess.PIPE, text=True)
    link = server.stdout.readline().strip()
    with browser.Browser() as chromium:
        driver = chromium.driver
        driver.execute_cdp_cmd("Network.emulateNetworkConditions", {
            "offline": False, "latency": 0, "downloadThroughput": -1, "uploadThroughput": -1})
        driver.set_script_timeout(600)
        driver.set_window_size(1280, 900)
        driver.get(link)
        browser.WebDriverWait(driver, 120, 0.1).until(lambda d: d.execute_script("return !!page.parts.live.shown"))
        changes = {key: json.loads(value) for key, value in (k.split("=") for k in keys)}
        driver.execute_async_script(MOVES, 10, changes)
        before = memory_mb(server.pid)
        times, made = driver.execute_async_script(MOVES, int(moves), changes)
        after = memory_mb(server.pid)
    server.send_signal(signal.SIGINT)
    server.wait()
    times.sort()
    print(f"{len(times)} moves: median {statistics.median(times):.1f} ms, p95 {times[int(0.95 * len(times))]:.1f} ms;"
          f" rendered in {statistics.median(made):.1f} ms (median); memory {before:.0f} -> {after:.0f} MB")


if __name__ == "__main__":
    main(*sys.argv[1:])
