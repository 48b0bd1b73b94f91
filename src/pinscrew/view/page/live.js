// Talking to Python: the state goes both ways; without a server the page works on alone.
"use strict";
(function (ps) {
  const BEAT = 4000; // ms without a word from the server, which speaks every second, after which it counts as gone

  const RESTARTED = 4001; // as in server.py

  class Live {
    constructor(app) {
      this.app = app;
      this.status = document.getElementById("status");
      this.status.hidden = false;
      this.heard = 0;
      this.connect();
      setInterval(() => {
        if (this.socket.readyState === WebSocket.OPEN && performance.now() - this.heard > BEAT) this.socket.close();
        if (performance.now() - this.heard > BEAT) this.show(false);
      }, 500);
    }

    connect() {
      this.socket = new WebSocket(`ws://${location.host}/live/${this.app.document.live}`);
      this.socket.onmessage = (event) => this.take(JSON.parse(event.data));
      this.socket.onclose = ({ code }) => {
        // Another process has the port: its page takes over, and what the address says of the state.
        if (code === RESTARTED) location.reload();
        this.show(false);
        setTimeout(() => this.connect(), 2000);
      };
    }

    show(connected) {
      this.connected = connected;
      this.status.textContent = connected ? "live" : "Python has gone; the page works on without it";
      this.status.classList.toggle("lost", !connected);
    }

    take(message) {
      this.heard = performance.now();
      this.show(true);
      // Who has moved the page before it was connected is not put back.
      if (message.type === "hello" && this.app.touched) this.tell();
      else if (message.type === "state" || message.type === "hello") {
        this.app.set(message, false);
      }
      if (message.type === "animate") this.app.player.load(message.animation, true);
    }

    // Tell Python where the page is; at most once a frame.
    tell() {
      if (this.pending) return;
      this.pending = true;
      requestAnimationFrame(() => {
        this.pending = false;
        const { q, qd, tip, kind, draw } = this.app.state;
        if (this.socket.readyState === WebSocket.OPEN) {
          this.socket.send(JSON.stringify({ type: "state", q, qd, tip, kind, draw: [...draw] }));
        }
      });
    }
  }

  ps.Live = Live;
})((globalThis.pinscrew = globalThis.pinscrew || {}));
