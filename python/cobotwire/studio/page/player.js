// Play a recording: position, speed, play and pause.

import { byId, clock } from "./dom.js";

export class Player {
  constructor(source, recording) {
    this.source = source;
    this.seconds = recording.seconds;
    this.playing = false;
    byId("scrub").max = recording.seconds;
    byId("recording-remarks").textContent = recording.remarks.join("; ");
    byId("play").addEventListener("click", () => {
      if (this.playing) source.wish("pause");
      else this.play();
    });
    byId("speed").addEventListener("input", () => this.playing && this.play());
    byId("scrub").addEventListener("input", () => {
      clearTimeout(this.timer);
      // While the handle moves, the page requests only some of the positions.
      this.timer = setTimeout(() => source.wish("seek", { value: Number(byId("scrub").value) }), 60);
      this.held = Date.now();
      this.write(Number(byId("scrub").value));
    });
  }

  play() {
    this.source.wish("play", { value: Number(byId("speed").value) });
  }

  show({ position, playing }) {
    this.playing = playing;
    byId("play").textContent = playing ? "Pause" : "Play";
    if (Date.now() - (this.held ?? 0) < 300) return;
    byId("scrub").value = position;
    this.write(position);
  }

  write(position) {
    byId("position").textContent = `${clock(position, 1)} of ${clock(this.seconds, 1)}`;
    byId("scrub").setAttribute("aria-valuetext", byId("position").textContent);
  }
}
