// The webcam: its pictures go to the pose model in this browser, and nowhere else.

const WIDTH = 320, HEIGHT = 240; // of the picture that the model is given, and of the preview
const PAUSE = 40; // ms between pictures, at least
const BONES = [[11, 12], [11, 13], [13, 15], [12, 14], [14, 16], [15, 19], [16, 20]];

export class Camera {
  #worker = null;
  #stream = null;
  #timer = null;
  #wanted = null; // what open() waits for; another once it was closed meanwhile

  // seen: called with each picture's joints (or null); failed: with why there are no more pictures, or null if it was taken.
  constructor(preview, seen, failed) {
    this.preview = preview;
    this.seen = seen;
    this.failed = failed;
    this.video = document.createElement("video");
    this.video.muted = this.video.playsInline = true;
    this.looked = document.createElement("canvas"); // the picture that the model looks at
    for (const canvas of [preview, this.looked]) Object.assign(canvas, { width: WIDTH, height: HEIGHT });
  }

  get on() { return this.#stream !== null; }

  async open() {
    this.close();
    const wanted = {};
    this.#wanted = wanted;
    try {
      const stream = await navigator.mediaDevices.getUserMedia({ video: { width: { ideal: 640 }, height: { ideal: 480 }, facingMode: "user" } });
      if (this.#wanted !== wanted) {
        for (const track of stream.getTracks()) track.stop();
        return;
      }
      this.#stream = stream;
      for (const track of stream.getTracks()) track.addEventListener("ended", () => this.#fail(null));
      this.video.srcObject = stream;
      await this.video.play();
      if (this.#wanted !== wanted) return;
      this.#worker = new Worker("pose-worker.js");
      this.#worker.onmessage = ({ data }) => this.#found(data);
      this.#worker.onerror = ({ message }) => this.#fail(message);
      await this.#look();
    } catch (error) {
      if (this.#wanted === wanted) this.#fail(error.message);
    }
  }

  close() {
    clearTimeout(this.#timer);
    this.#worker?.terminate();
    for (const track of this.#stream?.getTracks() ?? []) track.stop();
    this.#worker = this.#stream = this.#wanted = null;
    this.video.srcObject = null;
    this.preview.getContext("2d").clearRect(0, 0, WIDTH, HEIGHT);
  }

  #fail(reason) {
    this.close();
    this.failed(reason);
  }

  // Give the model the next picture: the middle of it, in the preview's shape.
  async #look() {
    if (!this.#worker) return;
    const { videoWidth: width, videoHeight: height } = this.video;
    const shown = Math.min(width, (height * WIDTH) / HEIGHT), high = (shown * HEIGHT) / WIDTH;
    this.asked = performance.now();
    const cut = [(width - shown) / 2, (height - high) / 2, shown, high];
    const picture = await createImageBitmap(this.video, ...cut, { resizeWidth: WIDTH, resizeHeight: HEIGHT });
    this.looked.getContext("2d").drawImage(picture, 0, 0);
    this.#worker?.postMessage(picture, [picture]);
  }

  #found({ joints, error }) {
    if (!this.on) return;
    if (error) {
      this.#fail(error);
      return;
    }
    this.#draw(joints);
    const frozen = this.#stream.getVideoTracks()[0].muted; // no new pictures come: the arm in the last one is down by now
    this.seen(frozen ? null : joints, WIDTH / HEIGHT);
    this.#timer = setTimeout(() => this.#look().catch((problem) => this.#fail(problem.message)), Math.max(0, this.asked + PAUSE - performance.now()));
  }

  // The preview is a mirror.
  #draw(joints) {
    const context = this.preview.getContext("2d");
    context.setTransform(-1, 0, 0, 1, WIDTH, 0);
    context.drawImage(this.looked, 0, 0);
    if (!joints) return;
    context.lineWidth = 4;
    context.lineCap = "round";
    context.strokeStyle = "#3fe0d4";
    context.beginPath();
    for (const [from, to] of BONES) {
      context.moveTo(joints[from].x * WIDTH, joints[from].y * HEIGHT);
      context.lineTo(joints[to].x * WIDTH, joints[to].y * HEIGHT);
    }
    context.stroke();
  }
}
