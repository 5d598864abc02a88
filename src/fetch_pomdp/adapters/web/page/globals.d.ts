// What browsers have and TypeScript's library of the DOM has not, and what the pose model's own script brings.

interface Recognition {
  lang: string;
  continuous: boolean;
  onresult: (event: { results: { transcript: string }[][]; resultIndex: number }) => void;
  onerror: (event: { error: string }) => void;
  onend: () => void;
  start(): void;
  stop(): void;
}
interface Window {
  SpeechRecognition?: new () => Recognition;
  webkitSpeechRecognition?: new () => Recognition;
}

declare const sampleRate: number;
declare class AudioWorkletProcessor {
  readonly port: MessagePort;
}
declare function registerProcessor(name: string, processor: new () => AudioWorkletProcessor): void;

declare function importScripts(...addresses: string[]): void;
interface Joint {
  x: number;
  y: number;
  visibility: number;
}
declare class Pose {
  constructor(settings: { locateFile: (name: string) => string });
  setOptions(options: Record<string, unknown>): void;
  onResults(found: (results: { image: Partial<ImageBitmap>; poseLandmarks?: Joint[] }) => void): void;
  send(input: { image: ImageBitmap }): Promise<void>;
}
