// What the stream of a capture sends; every field only if it is new.

export type Level = "error" | "warning" | "info";
export interface Warning {
  level: Level;
  text: string;
}
export interface Pose {
  p: [number, number, number];
  yaw: number;
  lost?: boolean;
}
export interface Mark {
  what: "point" | "place";
  text: string;
  p: [number, number, number] | null;
}
/** Where the walk had a problem; `kind` is the code of its finding. */
export interface MarkedStretch {
  kind: "TRACKING-LOST" | "WEAK-DIRECTION";
  p: Array<[number, number, number]>;
}
export interface Gap {
  p: [number, number];
  width_m: number;
  away_m: number;
}
export interface Gaps {
  gaps: Gap[];
  well: number | null;
  elsewhere?: number;
}
/** The coverage from above: cells as deflated base64. */
export interface Plan {
  seen: string;
  shape: [number, number];
  first_cell: [number, number];
  cell_m: number;
}
export interface Lidar {
  name: string;
  per_s: number;
  lost: number | null;
  clock: string;
  jumps: number;
}
export interface Fix {
  quality: number;
  sd_m?: [number, number, number] | null;
}
export interface Battery {
  charge: number;
  left_s: number | null;
  mains: boolean;
}
export interface Phone {
  level: number;
  charging: boolean;
}
export interface RecorderStatus {
  seconds: number;
  kernel_drops: number;
  file: { written_bytes: number; dropped: number };
  disk: { free_bytes: number; left_s: number | null };
}
export interface Loop {
  walked_m?: number | null;
  start_m: number;
  closed?: boolean;
  drift_m?: number | null;
}
export interface Motion {
  still_s: number;
  tilt_deg: number[];
  turned_deg: number[];
  axes: Array<{ quantity: string; shown: number }>;
}
export interface Points {
  start: number;
  count: number;
  total: number;
  generation: number;
  voxel_m: number;
}
export interface Message {
  project?: string;
  state?: string;
  server?: string;
  points?: Points;
  path?: { start: number; points: Array<[number, number, number]> };
  pose?: Pose;
  marks?: { start: number; marks: Mark[] };
  stretches?: { start: number; stretches: MarkedStretch[] };
  gaps?: Gaps;
  plan?: Plan;
  findings?: Warning[];
  lidars?: Lidar[];
  rates?: Record<string, number>;
  fix?: Fix | null;
  status?: RecorderStatus;
  battery?: Battery | null;
  loop?: Loop | null;
  motion?: Motion | null;
}
