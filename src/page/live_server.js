// Requests to the program that serves the page.
"use strict";

// new LiveServer(gone): gone() is called when the program does not keep the heart of a request.
class LiveServer {
  constructor(gone) {
    this.gone = gone;
    this.token = new URLSearchParams(location.search).get("token") ?? "";
  }

  // A Response; refusals are a line of text.
  async ask(path, body) {
    const headers = { "Content-Type": "application/json", "Echocine-Token": this.token };
    const response = await fetch(path, { method: "POST", headers, body: JSON.stringify(body) });
    if (response.status === 410) this.gone();
    return response;
  }

  // JSON after its length in 4 bytes, and the bytes that follow it.
  static parts(buffer) {
    const size = new DataView(buffer).getUint32(0, true);
    return [JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size))), new Uint8Array(buffer, 4 + size)];
  }
}
