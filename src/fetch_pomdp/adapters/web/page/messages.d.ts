// What server and page tell each other (docs/serve.md has it in words). For the type checker alone.

export type Point3 = [number, number, number]; // m
export interface Item {
  id: string;
  position: Point3;
  vocabulary: string[];
}
export interface Scene {
  items: Item[];
  head: Point3;
  sigma: number;
  threshold: number;
}
export type SceneChoice = string | { toml: string };
export type Belief = Record<string, number>; // by item
export type ActionName = "wait" | "point" | "pick";
export type Texts = { en: string } & Record<string, string>; // by language

export interface Phrase {
  key: string;
  values: Record<string, PhraseValue>;
}
export type PhraseValue = string | { number: string } | Phrase;

export interface Welcome {
  type: "welcome";
  scene: Scene;
  ears: boolean;
  insight: boolean;
  resumed: boolean;
  belief: Belief | null;
  past: (Observed | Acted)[];
  picked: string | null;
  asked: string | null; // the item of a question that waits for its answer
  resume?: string;
  scene_name?: string | null;
  planner?: string; // of a conversation, like those below
  begun?: boolean; // whether a request goes on
  examples?: string[];
}
export interface BeliefMessage {
  type: "belief";
  t: number;
  provisional: boolean;
  heard: string[];
  belief?: Belief;
  even?: boolean;
}
export interface Decided {
  type: "decided";
  t: number;
  action: ActionName;
  item?: string | null;
  phrase?: Phrase | null;
  values?: { wait: number | null; point: Record<string, number | null>; pick: Record<string, number | null> };
}
/** Where the talk stands after an event that has just happened. */
interface TalkState {
  asked?: string | null;
  begun?: boolean;
}
export interface Observed extends TalkState {
  type: "observed";
  t?: number;
  early?: boolean; // heard while the next action went on
  anew?: boolean; // begins another request
  unknown: string[];
  understood: boolean;
  reading: { meaning: string; whose: boolean } | null; // whose: whether it is open whose left or right is meant
  observation: { utterance?: string; head?: Point3; wrist?: Point3 };
}
export interface Acted extends TalkState {
  type: "action";
  t?: number;
  action: ActionName;
  item: string;
  outcome: "done" | "failed" | "stopped" | "returned";
  reason?: string;
}
export interface Say {
  type: "say";
  key: string | null;
  text: string;
  audio: string | null;
  words?: string; // those that the robot knows, if it has not understood anything
}
export interface Status {
  type: "status";
  sensor: "planner" | "model" | "robot" | "speech" | "skeleton";
  state: "ok" | "silent" | "slow" | "lost";
  text: string;
}
export interface Ended {
  type: "ended";
  picked: string | null;
}
export interface ErrorMessage {
  type: "error";
  code: string;
  message: string;
}

// Of a study.

export interface Countdown {
  type: "countdown";
  seconds: number;
}
export interface Begin {
  type: "begin";
  t: number;
}
export interface Heard {
  type: "heard";
  t: number;
  asked: string | null;
}
export interface Question {
  id: string;
  kind: "text" | "scale" | "choice" | "choices";
  text: Texts;
  required: boolean;
  points: number;
  options: { id: string; text: Texts }[];
}
interface Shown {
  type: "stage";
  title: Texts;
  code?: string;
  resume?: string;
}
export interface TrialStage extends Shown {
  stage: "practice" | "trials";
  order: number;
  of: number;
  desired: string;
  running: boolean;
  give_up: number;
}
export interface ConsentStage extends Shown {
  stage: "consent";
  text: Texts;
  keep_sound: boolean;
}
export interface InstructionsStage extends Shown {
  stage: "instructions";
  text: Texts;
  code: string;
  ears: boolean;
  practice: number;
  of: number;
}
export interface QuestionsStage extends Shown {
  stage: "questions";
  questions: Question[];
  order: number;
  of: number;
}
export interface DoneStage extends Shown {
  stage: "done";
  completion: string;
  code: string;
}
export interface LastStage extends Shown {
  stage: "withdrawn" | "declined" | "full";
}
export type PageStage = ConsentStage | InstructionsStage | QuestionsStage | DoneStage | LastStage;
export type Stage = TrialStage | PageStage;

export type ServerMessage =
  | Welcome
  | BeliefMessage
  | Decided
  | Observed
  | Acted
  | Say
  | Status
  | Ended
  | ErrorMessage
  | Countdown
  | Begin
  | Heard
  | Stage;

export interface Hello {
  scene?: SceneChoice;
  sigma?: number | null;
  planner?: string;
  seed?: number;
}
export type PageMessage =
  | ({ type: "hello"; version: 1; resume: string | null; participant: string | null; token: string | null } & Hello)
  | { type: "typed" | "typing"; text: string }
  | { type: "ray"; head: Point3; wrist: Point3 }
  | { type: "microphone"; on: boolean }
  | { type: "reply"; stage: string; values: Record<string, unknown> }
  | { type: "ready" | "next" | "give_up" | "withdraw" };
