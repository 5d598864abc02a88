// The webcam: its pictures go to the pose model in this browser, and nowhere else.

/**
 * @typedef {(joints: Joint[] | null, aspect: number) => void} Seen each picture's joints, or null; width over height
 *   of it
 */

const WIDTH = 320,
  HEIGHT = 240; // of the picture that the model is given, and of the preview
const PAUSE = 40; // ms between pictures, at least
const BONES = [
  [11, 12],
  [11, 13],
  [13, 15],
  [12, 14],
  [14, 16],
  [15, 19],
  [16, 20],
];

export class Camera {
  /** @type {Worker | null} */
  #worker = null;
  /** @type {MediaStream | null} */
  #stream = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timer;
  #askedAt = 0;
  /** @type {object | null} */
  #wanted = null; // what open() waits for; another once it was closed meanwhile

  /**
   * @param {HTMLCanvasElement} preview
   * @param {Seen} onSeen
   * @param {(reason: string | null) => void} onFail called with why there are no more pictures, or null if
   *   the camera was taken
   */
  constructor(preview, onSeen, onFail) {
    this.preview = preview;
    this.onSeen = onSeen;
    this.onFail = onFail;
    this.video = document.createElement("video");
    this.video.muted = this.video.playsInline = true;
    this.looked = document.createElement("canvas"); // the picture that the model looks at
    for (const canvas of [preview, this.looked]) Object.assign(canvas, { width: WIDTH, height: HEIGHT });
  }

  get on() {
    return this.#stream !== null;
  }

  async open() {
    this.close();
    const wanted = {};
    this.#wanted = wanted;
    try {
      const stream = await navigator.mediaDevices.getUserMedia({
        video: { width: { ideal: 640 }, height: { ideal: 480 }, facingMode: "user" },
      });
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
      this.#worker.onerror = (problem) => this.#fail(problem.message);
      await this.#look();
    } catch (error) {
      if (this.#wanted === wanted) this.#fail(message(error));
    }
  }

  close() {
    clearTimeout(this.#timer);
    this.#worker?.terminate();
    for (const track of this.#stream?.getTracks() ?? []) track.stop();
    this.#worker = this.#stream = this.#wanted = null;
    this.video.srcObject = null;
    context(this.preview).clearRect(0, 0, WIDTH, HEIGHT);
  }

  /** @param {string | null} reason */
  #fail(reason) {
    this.close();
    this.onFail(reason);
  }

  /** Give the model the next picture: the middle of it, in the preview's shape. */
  async #look() {
    if (!this.#worker) return;
    const { videoWidth: width, videoHeight: height } = this.video;
    const shown = Math.min(width, (height * WIDTH) / HEIGHT),
      high = (shown * HEIGHT) / WIDTH;
    this.#askedAt = performance.now();
    const picture = await createImageBitmap(this.video, (width - shown) / 2, (height - high) / 2, shown, high, {
      resizeWidth: WIDTH,
      resizeHeight: HEIGHT,
    });
    context(this.looked).drawImage(picture, 0, 0);
    this.#worker?.postMessage(picture, [picture]);
  }

  /** @param {{ joints: Joint[] | null, error?: string }} answer */
  #found({ joints, error }) {
    if (!this.#stream) return;
    if (error) {
      this.#fail(error);
      return;
    }
    this.#draw(joints);
    // No new pictures come: the arm in the last one is down by now.
    const frozen = this.#stream.getVideoTracks()[0].muted;
    this.onSeen(frozen ? null : joints, WIDTH / HEIGHT);
    this.#timer = setTimeout(
      () => this.#look().catch((problem) => this.#fail(message(problem))),
      Math.max(0, this.#askedAt + PAUSE - performance.now()),
    );
  }

  /** The preview is a mirror. @param {Joint[] | null} joints */
  #draw(joints) {
    const pen = context(this.preview);
    pen.setTransform(-1, 0, 0, 1, WIDTH, 0);
    pen.drawImage(this.looked, 0, 0);
    if (!joints) return;
    pen.lineWidth = 4;
    pen.lineCap = "round";
    pen.strokeStyle = "#3fe0d4";
    pen.beginPath();
    for (const [from, to] of BONES) {
      pen.moveTo(joints[from].x * WIDTH, joints[from].y * HEIGHT);
      pen.lineTo(joints[to].x * WIDTH, joints[to].y * HEIGHT);
    }
    pen.stroke();
  }
}

/** @param {HTMLCanvasElement} canvas */
function context(canvas) {
  const found = canvas.getContext("2d");
  if (!found) throw new TypeError("found no 2d context");
  return found;
}

/** @param {unknown} error */
const message = (error) => (error instanceof Error ? error.message : String(error));
