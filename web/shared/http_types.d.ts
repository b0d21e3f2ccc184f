// Generated from the server's OpenAPI description by `make docs`; do not edit.

export interface AccessTokenView {
  token: string;
}

export interface Account {
  name: string;
  role: Role;
  disabled: boolean;
  created: string;
}

export interface Acknowledgment {
  who: string;
  time: string;
  why: string;
  kind: string;
  span_s: [number, number] | null;
  finding: number | null;
}

export interface AcknowledgmentsView {
  may_acknowledge: boolean;
  notes: Array<Acknowledgment>;
}

export interface AddReference {
  path: string;
  frame?: "auto" | "map" | "crs";
  columns?: Array<"x" | "y" | "z" | "-x" | "-y" | "lat" | "lon" | "id" | "role" | "radius" | "-" | "se" | "sn" | "sh" | "cee" | "cen" | "ceh" | "cnn" | "cnh" | "chh">;
  unit?: "m" | "dm" | "cm" | "mm" | "km" | "ft" | "us-ft" | "in" | null;
  name?: string;
}

export interface AgreementView {
  rms_m: number | null;
  offset_m: number | null;
  imu_rms: number | null;
}

export interface AlignPoints {
  p_map: string;
  p_reference: string;
  middle_map: [number, number, number];
  middle_reference: [number, number, number];
  pose: [number, number, number, number, number, number, number];
}

export interface AlignRequest {
  how: "none" | "icp" | "pairs" | "undo";
  p_map?: Array<[number, number, number]>;
  p_reference?: Array<[number, number, number]>;
  level?: boolean;
  refine?: boolean;
  pose?: [number, number, number, number, number, number, number] | null;
}

export interface AlignmentView {
  measurement: string;
  T_i_j: Array<number>;
  converged: boolean;
  reason: string;
  overlap: number | null;
  error_m: number | null;
  limit_m: number | null;
  degeneracy: number | null;
  iterations: number;
}

export interface AlikeClusterView {
  origin_m: [number, number, number];
  columns: Array<[number, number, number, number]>;
  low_m: [number, number, number];
  high_m: [number, number, number];
  points: number;
  difference: number;
  over_ground_m: number | null;
  planarity: number;
  seen_through: number | null;
}

export interface AlikeView {
  only: string;
  edge_m: number;
  clusters: Array<AlikeClusterView>;
  left_out: number;
}

export interface AlternativePath {
  frames: Array<number>;
  residual_m: number;
  residual_rad: number;
}

export type ApprovalKind = "draft" | "approved" | "earlier" | "changed" | "unknown signer" | "not valid";

export interface ApprovalState {
  kind: ApprovalKind;
  text: string;
  code: string;
  values: Record<string, number | string>;
  detail: string;
  detail_code: string;
  detail_values: Record<string, number | string>;
  version: number | null;
  who: string;
  time: string;
  hash: string;
  verdict: string;
  why: string;
  checking: boolean;
}

export interface Approve {
  why?: string;
  confirmed?: boolean;
  after_seq?: number | null;
  graph?: string | null;
}

export interface Approved {
  name: string;
  address: string;
}

export interface Assignments {
  preset?: string;
  settings?: Array<string>;
}

export interface AxisStatistics {
  axis: "E" | "N" | "U";
  points: number;
  rmse_m: number | null;
  mean_m: number | null;
}

export interface BeamsContent {
  range_m: Array<number>;
  elevation_deg: Array<number>;
  azimuth_deg: Array<number>;
}

export interface BoxSpec {
  shape: "box";
  center_m: [number, number, number];
  size_m: [number, number, number];
  u?: [number, number, number];
  v?: [number, number, number];
}

export interface BrushSpec {
  shape: "brush";
  path_m: Array<[number, number, number]>;
  radius_m: number;
  across?: [number, number, number] | null;
  thick_m?: number;
}

export interface CalibratedVersion {
  rig: string;
  create?: boolean;
  note?: string;
}

export interface CalibrationSlices {
  thickness_m: number;
  lidars: Array<LidarSlicesView>;
}

export interface CalibrationView {
  outcome: string;
  applied: boolean;
  windows: number;
  rms_m: number | null;
  parameters: Array<ParameterView>;
  beams: Array<ParameterView>;
  before: AgreementView | null;
  after: AgreementView | null;
  rig: SavedRig | null;
  saved: SavedRig | null;
}

export interface CaptureChoices {
  presets: Array<string>;
  preset_texts: Record<string, string>;
  rigs: Array<RigChoice>;
}

export interface CaptureFinding {
  level: "error" | "warning" | "info";
  text: string;
}

export interface CaptureView {
  project: string;
  state: string;
  findings: Array<CaptureFinding>;
  rates: Record<string, number>;
  phones: number;
  may_capture: boolean;
}

export interface ChainView {
  entries: number;
  broken_at: number | null;
  newest: string;
}

export interface Changes {
  role?: Role | null;
  disabled?: boolean | null;
  password?: string | null;
}

export interface Choices {
  presets: Array<string>;
  preset_texts: Record<string, string>;
  rigs: Array<string>;
}

export interface ClassChoice {
  code: number;
  title: string;
  points: number;
  percent: number;
  delivered: boolean;
}

export interface ClusterSpec {
  origin_m: [number, number, number];
  columns: Array<[number, number, number, number]>;
  u?: [number, number, number];
  v?: [number, number, number];
}

export interface ClustersSpec {
  shape: "clusters";
  clusters: Array<ClusterSpec>;
  edge_m: number;
}

export interface CommentView {
  who: string;
  time: string;
  text: string;
}

export interface CompareOrder {
  against: string;
  align: boolean;
  core_spacing_m: number;
}

export interface CompareRequest {
  reference: string;
  method?: "plane" | "point";
  planes?: Array<SlicePlaneSpec>;
  source?: string;
}

export interface ComparedMap {
  name: string;
  key: string;
  points: number;
  registration: "stated" | "usual";
}

export interface ComparedSlice {
  name: string;
  points: number;
  outliers: number;
  mean_m: number | null;
  ratio_within_2cm: number | null;
  ratio_within_5cm: number | null;
  signed: SignedFigures;
  position: PlanePosition | null;
}

export interface Comparison {
  slices: Array<ComparedSlice>;
  point_weighted: ComparedSlice;
  plain_mean_m: number | null;
  outlier_m: number;
  histogram: Array<number>;
  histogram_step_m: number;
  histogram_end_m: number;
  fit: ReferenceFit;
  reference: string;
  method: "plane" | "point";
  alignment: string;
  notes: Array<string>;
}

export interface ComparisonView {
  id: string;
  against: string;
  align: boolean;
  core_spacing_m: number;
  state: JobState;
  person: string;
  created: string;
  note: string;
  fraction: number | null;
  kept: boolean;
  of_this_map: boolean;
  found: MapDifferences | null;
}

export interface Comparisons {
  others: Array<OtherMap>;
  comparisons: Array<ComparisonView>;
  step_m: number;
}

export interface ControlFile {
  name?: string;
  base64: string;
  columns?: Array<"x" | "y" | "z" | "-x" | "-y" | "lat" | "lon" | "id" | "role" | "radius" | "-" | "se" | "sn" | "sh" | "cee" | "cen" | "ceh" | "cnn" | "cnh" | "chh">;
  unit?: "m" | "dm" | "cm" | "mm" | "km" | "ft" | "us-ft" | "in" | null;
}

export interface ControlPoint {
  id: string;
  xyz_m: [number, number, number];
  role: "control" | "check";
  radius_m: number;
  covariance_m2: [number, number, number, number, number, number] | null;
}

export interface ControlPreview {
  points: Array<ControlPoint>;
  table: TablePreview;
  skipped: Array<string>;
  crs: string;
  lies: "map" | "crs" | "";
}

export interface ControlReport {
  rows: Array<Residual>;
  missing: Array<string>;
  outdated: Array<string>;
  absent: Array<string>;
  figures: Array<ResidualStatistics>;
  judged_by: "control" | "check" | null;
  passed: boolean | null;
  verdict: ControlVerdict;
  limits: string;
  hint: string;
}

export interface ControlSpec {
  id: string;
  xyz_m: [number, number, number];
  role?: "control" | "check";
  radius_m?: number;
  covariance_m2?: [number, number, number, number, number, number] | null;
}

export interface ControlState {
  points?: Array<ControlSpec>;
  frame?: "map" | "crs";
  picks?: Record<string, [number, number, number]>;
  along?: Record<string, Array<[number, number, number]>>;
  limits?: LimitsSpec;
  found_in?: Record<string, string>;
  version?: number | null;
}

export interface ControlVerdict {
  level: "good" | "warning" | "bad" | "note";
  text: string;
}

export interface CorrectionCount {
  points: number;
  now: Record<string, number>;
  inside: number;
  refused: string;
  seq: number;
}

export interface CorrectionSpec {
  volume: any;
  to: string;
  only?: Array<string>;
  map: string;
}

export interface CorrectionView {
  id: string;
  to: string;
  only: Array<string>;
  points: number;
  who: string;
  why: string;
  time: string;
  in_map: boolean;
}

export interface CorrectionsView {
  seq: number;
  corrections: Array<CorrectionView>;
  withdrawn: Array<string>;
  may_correct: boolean;
  may_process: boolean;
  classes: Array<string>;
  left_out: Array<string>;
}

export interface Credentials {
  name: string;
  password: string;
}

export interface DecidedEdge {
  pair: [number, number];
  chi2: number | null;
  verdict: string;
}

export interface Deleted {
  id: string;
  kind: "project" | "recording";
  project: string;
  deleted: string;
  goes: string;
}

export interface DeliveryCheck {
  intact: Array<string>;
  altered: Array<string>;
  missing: Array<string>;
  added: Array<string>;
  signer: string;
  doubt: string;
}

export interface DeliveryOrder {
  files: Array<string>;
  exports: Array<PackedExport>;
  license: string;
  language: string;
}

export interface Difference {
  chi2_before: number;
  chi2_after: number;
  edges_before: number;
  edges_after: number;
  moves: Array<Move>;
  rejected_automatically: Array<[number, number]>;
  accepted_automatically: Array<[number, number]>;
}

export interface DifferenceCounts {
  core_points: number;
  significant: number;
  below_lod: number;
  without_partner: number;
  without_normal: number;
  sparse: number;
}

export interface DistanceFigures {
  mean_m: number;
  sd_m: number;
  p50_m: number;
  p95_m: number;
  largest_m: number;
  lod_p50_m: number;
}

export interface DoubleReport {
  walls: Array<DoubleWall>;
  surfaces: Array<DoubleWall>;
  patches: number;
  double_patches: number;
  share: number;
  median_separation_m: number | null;
  p95_separation_m: number | null;
  median_sigma_m: number | null;
  points: number;
}

export interface DoubleWall {
  middle_m: [number, number, number];
  normal: [number, number, number];
  separation_m: number;
  limit_m: number;
  sigma_m: number;
  bimodality: number;
  share: number;
  patches: number;
  points: number;
  spans_s: [[number, number], [number, number]];
  frames: [[number, number], [number, number]];
}

export interface EdgeConflict {
  pair: [number, number];
  chi2: number;
  limit: number;
  residual_m: number;
  residual_rad: number;
  who: string;
}

export interface Effect {
  key: string;
  last: Difference;
  all: Difference;
  edges: Array<DecidedEdge>;
  conflicts: Array<EdgeConflict>;
  missing: Array<[number, number]>;
  changed: Array<[number, number]>;
  warnings: Array<string>;
  seconds: number;
}

export interface Entry {
  number: number;
  time: string;
  person: string;
  address: string;
  action: string;
  object: string;
  outcome: string;
  hash: string;
}

export interface ErrorEllipse {
  major_m: number;
  minor_m: number;
  azimuth_deg: number;
  up_m: number;
}

export type EventKind = "job.finished" | "approval.signed" | "test";

export interface ExportChoices {
  kinds: Array<ExportKind>;
  classes: Array<ClassChoice>;
  storeys: Array<StoreyChoice>;
  crs: string;
}

export interface ExportEstimate {
  points: number;
  bytes: number;
  is_most: boolean;
  sorted_bytes: number;
}

export interface ExportKind {
  name: string;
  title: string;
  programs: string;
  group: string;
  takes: Array<string>;
  point_bytes: number;
  thinned_bytes: number;
  with_notes: boolean;
  sorted_bytes: number;
}

export interface ExportOptions {
  crs?: string;
  raw?: boolean;
  all_points?: boolean;
  classes?: Array<number>;
  box_m?: [number, number, number, number, number, number] | null;
  clip?: Array<[number, number, number, number, number, number, number]>;
  storey?: string;
  thin_m?: number;
  pixel_m?: number;
  cell_m?: number;
  draft?: boolean;
}

export interface ExportOrder {
  file: string;
  options: ExportOptions;
  delivery: DeliveryOrder | null;
}

export interface ExportView {
  id: string;
  file: string;
  title: string;
  options: ExportOptions;
  state: JobState;
  person: string;
  created: string;
  finished: string;
  note: string;
  fraction: number | null;
  what: string;
  made: ExportedFile | null;
  kept: boolean;
  of_this_map: boolean;
  delivery: DeliveryOrder | null;
}

export interface ExportedFile {
  name: string;
  bytes: number;
  sha256: string;
  text: string;
  approval: string;
  approval_line: StoredText | null;
  map_key: string;
  recon4: string;
  points: number;
}

export interface FileBeside {
  name: string;
  content: string;
}

export interface FileView {
  name: string;
  bytes: number;
  offset: number;
  url: string;
}

export interface FirstAdmin {
  name: string;
  password: string;
  token: string;
}

export interface FolderEntry {
  name: string;
  path: string;
  folder: boolean;
  bytes: number;
}

export interface FoundTarget {
  p_map: [number, number, number];
  sd_m: number;
  sd_across_m: number;
  off_m: number;
}

export interface FreeRequest {
  what: Array<Freeable>;
}

export type Freeable = "earlier" | "frames" | "map";

export interface GnssContent {
  lever_arm_m?: [number, number, number];
  time_offset_s?: number;
  port: number;
  serial?: string;
  topic?: string;
}

export interface GroupView {
  name: string;
  text: string;
  settings: Array<SettingView>;
}

export interface GuestLink {
  id: string;
  project: string;
  label: string;
  by: string;
  created_s: number;
  until_s: number;
  opened: number;
  opened_s: number | null;
  revoked_s: number | null;
  revoked_by: string;
  works: boolean;
}

export interface GuestLinksView {
  login: boolean;
  links: Array<GuestLink>;
}

export interface GuestPlace {
  project: string;
}

export interface GuestToken {
  token: string;
}

export interface HitPoint {
  p_map: [number, number, number];
  p_crs: [number, number, number] | null;
  normal: [number, number, number] | null;
  t_s: number;
  sensor: string;
  classification: string;
  intensity: number;
  normalized: number | null;
  range_m: number | null;
  position_sd_m: number | null;
  surface_sd_m: number | null;
}

export interface ImuContent {
  sensor?: string;
  xyz_m?: [number, number, number];
  rpy_deg?: [number, number, number];
  time_offset_s?: number;
  port: number;
  topic?: string;
}

export interface Inputs {
  recordings: Array<string>;
  preset: string;
  rig: string;
  imu: string;
  gnss: string;
  settings: Array<string>;
  title: string;
  remake: boolean;
  export: ExportOrder | null;
  compare: CompareOrder | null;
  targets: TargetOrder | null;
}

export interface InvitationView {
  links: Array<PairingLink>;
  seconds: number;
  role: Role;
}

export interface Job {
  id: string;
  project: string;
  inputs: Inputs;
  created: string;
  state: JobState;
  attempt: number;
  started: string;
  finished: string;
  note: string;
  reason: JobReason | null;
  person: string;
  made: ExportedFile | null;
}

export interface JobReason {
  code: string;
  values: Record<string, boolean | number | string>;
}

export type JobState = "queued" | "running" | "succeeded" | "failed" | "cancelled";

export interface JobStatus {
  what: string;
  unit: string;
  done: number;
  total: number;
  rate_per_s: number;
  eta_s: number | null;
  stages: Array<StageStatus>;
}

export interface JobView {
  job: Job;
  status: JobStatus;
  fraction: number | null;
  run_progress: number;
  run_eta_s: number | null;
  resumable: boolean;
  workers: JobWorkers;
  remedy: RemedyLink | null;
}

export interface JobWorkers {
  workers: Array<WorkerRecord>;
  problem: string;
}

export type Judge = "odometry" | "search" | "free space" | "neighboring places" | "verification" | "robust solve" | "GNSS" | "person";

export interface Judgment {
  by: Judge;
  verdict: Verdict;
  reason: Reason;
  measure: Measure;
  value: number | null;
  limit: number | null;
  person: string;
  note: string;
}

export type Kept = "approved" | "being-written" | "unknown";

export interface KeyView {
  fingerprint: string;
  public_key: string;
  name: string;
  own: boolean;
  added: string;
  by: string;
  removed: string;
  removed_by: string;
}

export type Level = "good" | "note" | "check" | "do not use";

export interface LidarSlicesView {
  name: string;
  before: Array<[number, number]>;
  after: Array<[number, number]>;
}

export interface LikeSpec {
  place_m: [number, number, number];
  to: string;
  only?: Array<string>;
  map: string;
}

export interface LimitsSpec {
  mean_horizontal_m?: number | null;
  mean_height_m?: number | null;
  max_horizontal_m?: number | null;
  max_height_m?: number | null;
  distances_m?: number | null;
  survey_sd_m?: number;
}

export interface ListedReference {
  id: string;
  name: string;
  file: string;
  frame: "map" | "crs";
  T_map_reference: Array<Array<number>> | null;
  alignment: string;
  fit: string;
  fits: boolean | null;
  can_undo: boolean;
  kind: "mesh" | "cloud" | "damaged";
  points: number;
  triangles: number;
  columns: Array<"x" | "y" | "z" | "-x" | "-y" | "lat" | "lon" | "id" | "role" | "radius" | "-" | "se" | "sn" | "sh" | "cee" | "cen" | "ceh" | "cnn" | "cnh" | "chh">;
  unit: "m" | "dm" | "cm" | "mm" | "km" | "ft" | "us-ft" | "in" | "";
  notes: Array<string>;
  problem: string;
}

export interface Log {
  entries: Array<Entry>;
  chain: ChainView;
}

export interface LogPiece {
  text: string;
  next: number;
}

export interface LookerView {
  who: string;
  frame_i: number | null;
  frame_j: number | null;
}

export interface Looking {
  page: string;
  frame_i?: number | null;
  frame_j?: number | null;
}

export interface M3C2Scales {
  core_spacing_m: number;
  normal_m: number;
  cylinder_m: number;
  depth_m: number;
  layer_m: number;
}

export interface MapColumn {
  name: "intensity" | "normalized" | "time" | "uncertainty" | "thickness";
  unit: string;
  offset: number;
  scale: number;
  low: number;
  high: number;
}

export interface MapDifferences {
  first: ComparedMap;
  second: ComparedMap;
  relation: string;
  T_a_b: Array<Array<number>>;
  scales: M3C2Scales;
  counts: DifferenceCounts;
  distances: DistanceFigures | null;
}

export interface MapFacts {
  verdict: MapVerdict | null;
  reason_needed: string;
  min_reason_characters: number;
  notes: Array<string>;
  findings: Array<SaidFinding> | null;
  figures: Record<string, any>;
}

export interface MapIndex {
  key: string;
  version: number;
  points: number;
  low_m: [number, number, number];
  high_m: [number, number, number];
  tiles: Array<MapTile>;
  columns: Array<MapColumn>;
  color: "normalized" | "intensity" | "height";
  classes: Record<string, string>;
  class_percent: Record<string, number>;
  storeys: Array<Storey>;
  crs: string;
  frame: string;
  surface: string;
  seconds: number;
}

export interface MapNote {
  id: string;
  p_map: [number, number, number];
  key: string;
  text: string;
  status: "open" | "done";
  who: string;
  time: string;
  changed_by: string;
  changed: string;
  revision: number;
  camera: NoteView | null;
  photo: string;
}

export interface MapTile {
  low_m: [number, number, number];
  high_m: [number, number, number];
  points: number;
  sample: number;
  coarse: number;
  cube: number;
  spacing_m: number;
}

export interface MapVerdict {
  usability: Usability;
  reasons: Array<string>;
  unobserved: Array<Unobserved>;
}

export interface MapViewsView {
  may_change: boolean;
  views: Array<SavedMapView>;
}

export interface MapVolume {
  above_m3: number;
  below_m3: number;
  sd_m3: number;
  area_m2: number;
  unseen_m2: number;
  base_m: number;
  fitted: number;
  cell_m: number;
}

export interface MapWalk {
  t_s: Array<number>;
  positions_m: Array<[number, number, number]>;
  nodes_m: Array<[number, number, number]>;
  marks: Array<OperatorMark>;
  marks_left_out: number;
}

export interface Me {
  name: string;
  role: Role;
  may: Array<Permission>;
  login: boolean;
  token: string;
}

export type Measure = "" | "overlap" | "error_m" | "match_ratio" | "degeneracy" | "seen_through" | "confirmed_nodes" | "contradicted_nodes" | "verification_m" | "chi2";

export interface Move {
  node: number;
  frame_id: number;
  t_ns: number;
  moved_m: number;
}

export interface NewAccessToken {
  label: string;
  role?: Role;
  days?: number;
}

export interface NewAcknowledgment {
  finding: number;
  kind: string;
  span_s?: [number, number] | null;
  why: string;
}

export interface NewCapture {
  project?: string;
  rig?: string;
  preset?: string;
  place?: string;
}

export interface NewComparison {
  against: string;
  align?: boolean;
  core_spacing_m?: number;
}

export interface NewCorrection {
  volume: any;
  to: string;
  only?: Array<string>;
  map: string;
  why?: string;
  seen_seq: number;
}

export interface NewDecision {
  kind: "accept" | "reject" | "restore" | "replace" | "add";
  frame_i: number;
  frame_j: number;
  why?: string;
  T_i_j?: Array<number>;
  measurement?: string;
  seen_seq?: number | null;
}

export interface NewDelivery {
  files?: Array<string>;
  exports?: Array<string>;
  license?: string;
  language?: string;
}

export interface NewExport {
  file: string;
  options?: ExportOptions;
  delivery?: NewDelivery | null;
}

export interface NewGuestLink {
  label: string;
  days: number;
}

export interface NewGuestLinkView {
  link: GuestLink;
  token: string;
}

export interface NewInvitation {
  role: Role;
}

export interface NewJob {
  project?: string;
  title?: string;
  recordings: Array<string>;
  preset?: string;
  rig?: string;
  imu?: string;
  gnss?: string;
  settings?: Array<string>;
  clone_of?: string;
  only_new?: boolean;
}

export interface NewKey {
  name: string;
  public_key: string;
}

export interface NewMapView {
  name: string;
  query: string;
}

export interface NewMark {
  what?: "point" | "place";
  text?: string;
  ago_s?: number;
}

export interface NewNote {
  p_map: [number, number, number];
  text: string;
  key: string;
  camera?: NoteView | null;
}

export interface NewPassword {
  old: string;
  new: string;
}

export interface NewPerson {
  name: string;
  role: Role;
  password: string;
}

export interface NewRequest {
  name?: string;
}

export interface NewRig {
  id: string;
  content?: RigContent | null;
  toml?: string | null;
  beside?: Array<FileBeside>;
  copy_of?: string;
  note?: string;
}

export interface NewUpload {
  name: string;
  files: number;
  bytes: number;
  fingerprint?: string;
}

export interface NewVersion {
  content?: RigContent | null;
  toml?: string | null;
  beside?: Array<FileBeside>;
  note?: string;
  after?: number | null;
}

export interface NewWebhook {
  url: string;
  events?: Array<EventKind>;
  secret?: string;
}

export interface NewWebhookView {
  webhook: Webhook;
  secret: string;
}

export interface NewWork {
  kind: "assign" | "comment" | "skip" | "second" | "waive";
  frame_i: number;
  frame_j: number;
  why?: string;
  assignee?: string;
}

export interface NoteChange {
  revision: number;
  text?: string | null;
  status?: "open" | "done" | null;
}

export interface NotePhoto {
  revision: number;
  base64: string;
}

export interface NoteView {
  eye_m: [number, number, number];
  ahead: [number, number, number];
  up: [number, number, number];
  parallel?: boolean;
  height_m?: number;
  aspect?: number;
}

export interface NotesView {
  may_change: boolean;
  notes: Array<MapNote>;
}

export interface OperatorMark {
  t_s: number;
  p_map: [number, number, number];
  text: string;
  who: string;
}

export type OpinionAgreement = "none" | "one" | "agree" | "disagree";

export interface OpinionView {
  who: string;
  accepted: boolean;
}

export interface OtherMap {
  id: string;
  kind: "map" | "project";
  name: string;
  label: string;
}

export interface PackedExport {
  id: string;
  file: string;
  options: ExportOptions;
  made: ExportedFile;
}

export interface PairFacts {
  pair: [number, number];
  t_ns: [number, number];
  predicted: Array<number>;
  odometry: Array<number>;
  measured: Array<number> | null;
  upright: Array<number>;
  apart_m: number;
  apart_rad: number;
  paths: Array<AlternativePath>;
  path_count: number;
  history: Array<Judgment>;
}

export interface PairingApproval {
  code: string;
  role: Role;
}

export interface PairingLink {
  host: string;
  url: string;
  qr: string;
}

export interface PairingRequestView {
  code: string;
  token: string;
  seconds: number;
}

export interface PairingView {
  login: boolean;
  roles: Array<Role>;
  fingerprint: string;
}

export interface ParameterView {
  sensor: string;
  quantity: string;
  axis: string;
  unit: "rad" | "m" | "s";
  change: number;
  sd: number | null;
  status: "consistent" | "off" | "not observable";
}

export interface PasswordConfirmation {
  password: string;
}

export type Permission = "shared" | "look" | "review" | "process" | "capture" | "share" | "administer";

export interface PickRequest {
  plane: SlicePlaneSpec;
  uv: [number, number];
  radius_m?: number;
  source?: string;
  surface?: "fitted" | "raw" | "strays";
}

export interface PickView {
  found: boolean;
  p_map: [number, number, number];
  p_crs: [number, number, number] | null;
  uv: [number, number];
  about: Record<string, number>;
  along: Array<[number, number, number]>;
  target: FoundTarget | null;
}

export interface PlanePosition {
  kind: "horizontal" | "vertical" | "free";
  normal: [number, number, number];
  offset_m: number;
  azimuth_deg: number;
}

export interface PointPairs {
  p_i: Array<Array<number>>;
  p_j: Array<Array<number>>;
}

export interface PointsInCrs {
  crs: string;
  p_crs: Array<[number, number, number]>;
}

export interface PointsInMap {
  key: string;
  p_map: Array<[number, number, number]>;
}

export interface PredictedPose {
  frame_i: number;
  frame_j: number;
  T_i_j: Array<number>;
}

export interface PrismSpec {
  shape: "prism";
  polygon_m: Array<[number, number]>;
  low_m: number;
  high_m: number;
  origin_m?: [number, number, number];
  u?: [number, number, number];
  v?: [number, number, number];
}

export interface ProblemDetail {
  error: string;
  detail: string;
  code: string;
  values: Record<string, boolean | number | string>;
  problems: Record<string, string>;
  candidates: Array<string>;
  remedy: RemedyLink | null;
}

export interface ProjectCard {
  id: string;
  name: string;
  finished: boolean;
  updated: string;
  preset: string;
  rig: string;
  has_map: boolean;
  tags: Array<string>;
  archived: boolean;
  recording: string;
  path_length_m: number | null;
  points: number | null;
  approval: ApprovalState;
  usability: string;
  problem: string;
}

export interface ProjectChanges {
  name?: string | null;
  tags?: Array<string> | null;
  archived?: boolean | null;
}

export interface ProjectSpace {
  id: string;
  bytes: number;
  freeable: Record<string, number>;
}

export interface ProjectStorage {
  parts: Array<StoredPart>;
  keep_earlier_s: number;
}

export interface ProjectView {
  id: string;
  name: string;
  finished: boolean;
  updated: string;
  bytes: number;
  preset: string;
  rig: string;
  files: Array<ResultFile>;
  stages: Array<StageView>;
  tags: Array<string>;
  archived: boolean;
  viewable: boolean;
  has_map: boolean;
  summary: Record<string, any>;
  approval: ApprovalState;
  problem: string;
}

export interface RayHit {
  point: HitPoint | null;
  snap: SnapPoint | null;
}

export interface RayRequest {
  key: string;
  origin_m: [number, number, number];
  direction: [number, number, number];
  pixel_rad: number;
  point_m: number;
  planes?: Array<[number, number, number, number]>;
  snap_rad?: number;
  snap_m?: number;
}

export type Reason = "" | "overlap < t_o" | "error > limit" | "not converged" | "too few segments match" | "degenerate" | "free space contradicts it" | "neighboring places do not confirm it" | "ambiguous: places look alike" | "verification median > limit" | "outlier in the robust solution" | "operator";

export interface RecordingSummary {
  path: string;
  kind: string;
  bytes: number;
  seconds: number;
  estimated: boolean;
  sensors: Array<SensorSummary>;
  samples: Array<string>;
  derived: Array<string>;
  missing: Array<string>;
  warnings: Array<string>;
  project: string;
  preset: string;
  rig: string;
  imu: string;
  gnss: string;
  first_rig: string;
}

export interface ReferenceFile {
  path: string;
  frame?: "auto" | "map" | "crs";
  columns?: Array<"x" | "y" | "z" | "-x" | "-y" | "lat" | "lon" | "id" | "role" | "radius" | "-" | "se" | "sn" | "sh" | "cee" | "cen" | "ceh" | "cnn" | "cnh" | "chh">;
  unit?: "m" | "dm" | "cm" | "mm" | "km" | "ft" | "us-ft" | "in" | null;
}

export interface ReferenceFit {
  near_ratio: number;
  walls_ratio: number | null;
  level_ratio: number | null;
  fits: boolean | null;
  text: string;
}

export interface ReferencePreview {
  table: TablePreview | null;
}

export interface RemedyLink {
  text: string;
  page: string;
  needs: string;
}

export interface Requirement {
  label: string;
  component: "horizontal" | "east" | "north" | "height" | "distances";
  points: number;
  value_m: number | null;
  limit_m: number;
  holds: boolean | null;
  text: string;
}

export interface Residual {
  id: string;
  role: "control" | "check";
  east_m: number | null;
  north_m: number | null;
  up_m: number | null;
  d2_m: number | null;
  d3_m: number | null;
  directions: number;
  across_m: number | null;
  stated: ErrorEllipse | null;
  sigmas: number | null;
  survey: ErrorEllipse | null;
  outlier: boolean;
}

export interface ResidualStatistics {
  role: "control" | "check";
  points: number;
  axes: [AxisStatistics, AxisStatistics, AxisStatistics];
  mean_2d_m: number | null;
  mean_up_m: number | null;
  max_2d_m: number | null;
  max_up_m: number | null;
  rmse_3d_m: number | null;
  relative_m: number | null;
  requirements: Array<Requirement>;
}

export interface Restored {
  project: string;
}

export interface ResultFile {
  name: string;
  label: string;
  bytes: number;
}

export interface ReviewView {
  seq: number;
  key: string;
  graph: string;
  undoable: number;
  redoable: number;
  standing: Array<StandingView>;
  work: Array<WorkView>;
  obstacle: string;
  in_map: boolean;
  finished: boolean;
  map: MapFacts | null;
  busy: boolean;
  may_review: boolean;
  may_process: boolean;
  approval: ApprovalState;
}

export interface RigCard {
  id: string;
  shipped: boolean;
  name: string;
  sensors: Array<string>;
  version: number;
  when: string;
  path: string;
  problem: string;
}

export interface RigCheck {
  problems: Record<string, string>;
  warnings: Array<string>;
}

export interface RigChoice {
  rig: string;
  name: string;
  sensors: Array<string>;
  problem: string;
}

export interface RigContent {
  name: string;
  sensors: Array<SensorContent>;
  imu: ImuContent;
  gnss: GnssContent;
}

export interface RigUse {
  project: string;
  name: string;
  version: number;
}

export interface RigVersion {
  number: number;
  path: string;
  who: string;
  when: string;
  note: string;
  evidence: string;
  name: string;
  sensors: Array<string>;
  digest: string;
  sha256: string;
  problem: string;
}

export interface RigView {
  id: string;
  shipped: boolean;
  version: number;
  content: RigContent;
  versions: Array<RigVersion>;
  uses: Array<RigUse>;
}

export type Role = "nobody" | "guest" | "viewer" | "operator" | "reviewer" | "admin";

export interface RowView {
  seq: number;
  time: string;
  who: string;
  kind: string;
  frame_i: number | null;
  frame_j: number | null;
  why: string;
  hash: string;
}

export interface SaidFinding {
  kind: string;
  level: Level;
  title: string;
  text: string;
  remedy: string;
  span_s: [number, number] | null;
  place_m: [[number, number, number], [number, number, number]] | null;
  direction: string;
  sensor: string;
  values: Record<string, boolean | number | string | null>;
}

export interface SavedMapView {
  id: string;
  name: string;
  query: string;
  who: string;
  time: string;
}

export interface SavedRig {
  id: string;
  version: number;
}

export interface SensorContent {
  name: string;
  kind?: "lidar" | "profiler" | "laser2d";
  model?: string;
  xyz_m?: [number, number, number];
  rpy_deg?: [number, number, number];
  time_offset_s?: number;
  clock_rate_ppm?: number;
  address?: string;
  port?: number;
  topic?: string;
  head_topic?: string;
  head_rate_deg_s?: number;
  enabled?: boolean;
  serial?: string;
  description?: string;
  beams?: BeamsContent | null;
  fields?: string;
}

export interface SensorModel {
  model: string;
  elevation_deg: [number, number] | null;
}

export interface SensorSummary {
  label: string;
  model: string;
  content: string;
  count: number;
  rate_hz: number | null;
}

export interface ServerView {
  version: string;
  free_bytes: number;
  disk_bytes: number;
  reserve_bytes: number;
  notices: Array<string>;
}

export interface Session {
  id: string;
  person: string;
  role: Role;
  began_s: number;
  proved_s: number;
  seen_s: number;
  address: string;
  agent: string;
  phone: boolean;
  guest_link: string;
  project: string;
  access_token: string;
  until_s: number;
}

export interface SessionView {
  session: Session;
  current: boolean;
}

export interface SettingView {
  path: string;
  name: string;
  kind: string;
  choices: Array<string>;
  unit: string;
  text: string;
  default: any;
  value: any;
}

export interface SettingsCheck {
  problems: Record<string, string>;
}

export interface SignedFigures {
  points: number;
  mean_m: number | null;
  sd_m: number | null;
  shift_m: [number | null, number | null, number | null];
}

export interface SiteSystem {
  crs?: string;
}

export interface SiteTrial {
  points: Array<TriedPoint>;
  remarks: Array<string>;
  text: string;
  forbidden: Array<string>;
  unseen: Array<string>;
}

export interface SliceFacts {
  points: number;
  strays: number;
  surface: "fitted" | "raw" | "strays";
  bounds_m: [[number, number, number], [number, number, number]];
  fields: Array<string>;
  sensors: Array<string>;
  seconds: number;
  key: string;
  crs: string;
  frame: string;
  approval: ApprovalState;
  references: Array<ListedReference>;
  sources: Array<OtherMap>;
}

export interface SliceImageRequest {
  plane: SlicePlaneSpec;
  window?: WindowSpec | null;
  color?: "height" | "intensity" | "normalized" | "time" | "sensor" | "distance";
  low?: number | null;
  high?: number | null;
  reference?: string;
  method?: "plane" | "point";
  source?: string;
  surface?: "fitted" | "raw" | "strays";
  width: number;
  height: number;
  ground?: "light" | "dark";
  page?: string;
  sequence?: number;
}

export interface SliceImageView {
  png: string;
  window: WindowSpec;
  pixel_m: number;
  points: number;
  surface: "fitted" | "raw" | "strays";
  name: string;
  position: PlanePosition;
  low: number;
  high: number;
  colors: Array<string>;
  axes: [string, string];
  origin_m: [number, number, number];
  u: [number, number, number];
  v: [number, number, number];
  offset_m: number;
  seconds: number;
}

export interface SlicePlaneSpec {
  kind: "horizontal" | "vertical" | "free";
  z_m?: number;
  a_m?: [number, number];
  b_m?: [number, number];
  origin_m?: [number, number, number];
  normal?: [number, number, number];
  thickness_m?: number;
}

export interface SnapPoint {
  kind: "corner" | "edge" | "plane";
  p_map: [number, number, number];
  p_crs: [number, number, number] | null;
  sd_m: number;
}

export interface SphereSpec {
  shape: "sphere";
  center_m: [number, number, number];
  radius_m: number;
}

export interface StageStatus {
  stage: string;
  state: string;
  seconds: number | null;
}

export interface StageView {
  stage: string;
  seconds: number;
  peak_bytes: number;
  finished: string;
}

export interface StandingView {
  frame_i: number;
  frame_j: number;
  accepted: boolean;
  who: string;
  why: string;
  measured: boolean;
  T_i_j: Array<number>;
}

export interface Step {
  after_seq?: number | null;
  why?: string;
}

export interface StorageView {
  disk_bytes: number;
  free_bytes: number;
  items: Array<StoredItem>;
  server_bytes: number;
}

export interface StoredItem {
  kind: "project" | "recording" | "upload" | "deleted";
  id: string;
  name: string;
  bytes: number;
  used_by: Array<string>;
  expires: string;
}

export interface StoredPart {
  name: string;
  what: string;
  bytes: number;
  freeable: Freeable | null;
  why: string;
  kept: Kept | null;
  version: number | null;
}

export interface StoredText {
  text: string;
  code: string;
  values: Record<string, number | string>;
}

export interface Storey {
  name: string;
  floor_m: number;
  walk_m: number;
  ceiling: boolean;
}

export interface StoreyChoice {
  name: string;
  floor_m: number;
}

export interface SupersededEffect {
  superseded: true;
}

export interface SurfacePoint {
  p_map: [number, number, number];
  surface: [number, number, number] | null;
  normal: [number, number, number] | null;
}

export interface TablePreview {
  header: Array<string>;
  rows: Array<Array<string>>;
  columns: Array<"x" | "y" | "z" | "-x" | "-y" | "lat" | "lon" | "id" | "role" | "radius" | "-" | "se" | "sn" | "sh" | "cee" | "cen" | "ceh" | "cnn" | "cnh" | "chh">;
  unit: "m" | "dm" | "cm" | "mm" | "km" | "ft" | "us-ft" | "in";
  question: string;
  description: string;
  delimiter: string;
  decimal: string;
}

export type TargetKind = "plate" | "board" | "sphere";

export interface TargetList {
  rows: Array<TargetRow>;
  missing: Array<string>;
  rmse_m: number | null;
}

export interface TargetOrder {
  radii_m: Array<number>;
}

export interface TargetRow {
  kind: TargetKind;
  p_map: [number, number, number];
  cov_m2: [[number, number, number], [number, number, number], [number, number, number]];
  sd_m: number;
  size_m: number;
  points: number;
  agreement: number;
  id: string;
  off_m: number | null;
  ambiguous: boolean;
}

export interface TargetSearch {
  id: string;
  state: JobState;
  person: string;
  created: string;
  note: string;
  step: string;
  fraction: number | null;
  kept: boolean;
  of_this_map: boolean;
}

export interface Token {
  token: string;
}

export interface TrajectoryNodes {
  frames: Array<number>;
  t_s: Array<number>;
  xyz_m: Array<Array<number>>;
}

export interface TriedPoint {
  id: string;
  role: string;
  off_m: [number | null, number | null, number | null];
  w: number | null;
  limit: number | null;
  said: string;
}

export interface Unobserved {
  start_s: number;
  end_s: number;
  direction: string;
  degeneracy: number;
  from_m: Array<number>;
  to_m: Array<number>;
}

export interface UploadView {
  id: string;
  name: string;
  files: number;
  bytes: number;
  received: number;
  fingerprint: string;
  by: string;
  created: string;
  expires: string;
  finished: boolean;
  recording: string;
  folder: string;
}

export type Usability = "good" | "check" | "do not use";

export type Verdict = "accepted" | "rejected" | "unverified";

export interface VolumeRequest {
  key: string;
  polygon: Array<[number, number]>;
  base_m?: number | null;
  low_m?: number | null;
  high_m?: number | null;
}

export interface WalkStretch {
  positions_m: Array<[number, number, number]>;
}

export interface Webhook {
  id: string;
  url: string;
  events: Array<EventKind>;
  created: string;
  by: string;
  waiting: number;
  problem: string;
}

export interface WebhookDelivery {
  number: number;
  event: string;
  kind: EventKind;
  created: string;
  attempts: number;
  delivered: string;
  next_attempt: string;
  problem: string;
}

export interface WindowSpec {
  left: number;
  bottom: number;
  right: number;
  top: number;
}

export interface WorkView {
  frame_i: number;
  frame_j: number;
  assignee: string;
  skipped_by: string;
  second_by: string;
  comments: number;
  opinions: Array<OpinionView>;
  agreement: OpinionAgreement;
  waits: boolean;
}

export interface WorkerChoice {
  count?: number;
  scheduler?: string;
  dashboard?: string;
}

export interface WorkerChoiceView {
  count: number;
  scheduler: string;
  dashboard: string;
  folder: string;
  has_certificates: boolean;
}

export interface WorkerRecord {
  name: string;
  part: string;
  made: number;
  failed: number;
  seconds: number;
}

export interface WorkerTestView {
  ok: boolean;
  text: string;
}

export interface Operations {
  "DELETE /api/keys/{fingerprint}": {
    path: { fingerprint: string };
    response: KeyView;
  };
  "DELETE /api/me/sessions/{session_id}": {
    path: { session_id: string };
    response: string;
  };
  "DELETE /api/projects/{project_id}": {
    path: { project_id: string };
    response: Deleted;
  };
  "DELETE /api/projects/{project_id}/exports/{export_id}/file": {
    path: { project_id: string; export_id: string };
    response: ExportView;
  };
  "DELETE /api/projects/{project_id}/guests/{link_id}": {
    path: { project_id: string; link_id: string };
    response: GuestLink;
  };
  "DELETE /api/projects/{project_id}/notes/{note_id}": {
    path: { project_id: string; note_id: string };
    response: string;
  };
  "DELETE /api/projects/{project_id}/notes/{note_id}/photo": {
    path: { project_id: string; note_id: string };
    query: { revision: number };
    response: MapNote;
  };
  "DELETE /api/projects/{project_id}/review/classes/{correction}": {
    path: { project_id: string; correction: string };
    response: CorrectionsView;
  };
  "DELETE /api/projects/{project_id}/slices/control/site": {
    path: { project_id: string };
    response: string;
  };
  "DELETE /api/projects/{project_id}/slices/references/{reference_id}": {
    path: { project_id: string; reference_id: string };
    response: string;
  };
  "DELETE /api/projects/{project_id}/views/{view_id}": {
    path: { project_id: string; view_id: string };
    response: string;
  };
  "DELETE /api/recordings/{name}": {
    path: { name: string };
    response: Deleted;
  };
  "DELETE /api/sessions/{session_id}": {
    path: { session_id: string };
    response: string;
  };
  "DELETE /api/trash/{deleted_id}": {
    path: { deleted_id: string };
    response: string;
  };
  "DELETE /api/uploads/files/{file_id}": {
    path: { file_id: string };
    response: string;
  };
  "DELETE /api/uploads/{upload_id}": {
    path: { upload_id: string };
    response: string;
  };
  "DELETE /api/webhooks/{webhook_id}": {
    path: { webhook_id: string };
    response: string;
  };
  "GET /api/audit": {
    query?: { most?: number; before?: number | null };
    response: Log;
  };
  "GET /api/choices": {
    response: Choices;
  };
  "GET /api/events": {
    response: string;
  };
  "GET /api/jobs": {
    response: Array<JobView>;
  };
  "GET /api/jobs/{job_id}": {
    path: { job_id: string };
    response: JobView;
  };
  "GET /api/jobs/{job_id}/log": {
    path: { job_id: string };
    query?: { lines?: number };
    response: string;
  };
  "GET /api/jobs/{job_id}/log/file": {
    path: { job_id: string };
    response: string;
  };
  "GET /api/jobs/{job_id}/log/since": {
    path: { job_id: string };
    query?: { offset?: number };
    response: LogPiece;
  };
  "GET /api/keys": {
    response: Array<KeyView>;
  };
  "GET /api/live": {
    response: CaptureView | null;
  };
  "GET /api/live/choices": {
    response: CaptureChoices;
  };
  "GET /api/look": {
    query: { path: string };
    response: RecordingSummary;
  };
  "GET /api/me": {
    response: Me;
  };
  "GET /api/me/sessions": {
    response: Array<SessionView>;
  };
  "GET /api/pairing": {
    response: PairingView;
  };
  "GET /api/people": {
    response: Array<Account>;
  };
  "GET /api/projects": {
    response: Array<ProjectCard>;
  };
  "GET /api/projects/{project_id}": {
    path: { project_id: string };
    response: ProjectView;
  };
  "GET /api/projects/{project_id}/calibration": {
    path: { project_id: string };
    response: CalibrationView | null;
  };
  "GET /api/projects/{project_id}/calibration/slices": {
    path: { project_id: string };
    response: CalibrationSlices | null;
  };
  "GET /api/projects/{project_id}/client.html": {
    path: { project_id: string };
    response: string;
  };
  "GET /api/projects/{project_id}/comparisons": {
    path: { project_id: string };
    response: Comparisons;
  };
  "GET /api/projects/{project_id}/comparisons/{comparison_id}": {
    path: { project_id: string; comparison_id: string };
    response: ComparisonView;
  };
  "GET /api/projects/{project_id}/comparisons/{comparison_id}/file": {
    path: { project_id: string; comparison_id: string };
    response: string;
  };
  "GET /api/projects/{project_id}/comparisons/{comparison_id}/points": {
    path: { project_id: string; comparison_id: string };
    response: string;
  };
  "GET /api/projects/{project_id}/exports": {
    path: { project_id: string };
    response: Array<ExportView>;
  };
  "GET /api/projects/{project_id}/exports/choices": {
    path: { project_id: string };
    response: ExportChoices;
  };
  "GET /api/projects/{project_id}/exports/{export_id}/check": {
    path: { project_id: string; export_id: string };
    response: DeliveryCheck;
  };
  "GET /api/projects/{project_id}/exports/{export_id}/file": {
    path: { project_id: string; export_id: string };
    response: string;
  };
  "GET /api/projects/{project_id}/files/{name}": {
    path: { project_id: string; name: string };
    response: string;
  };
  "GET /api/projects/{project_id}/findings.{ending}": {
    path: { project_id: string; ending: string };
    response: string;
  };
  "GET /api/projects/{project_id}/guests": {
    path: { project_id: string };
    response: GuestLinksView;
  };
  "GET /api/projects/{project_id}/jobs": {
    path: { project_id: string };
    response: Array<JobView>;
  };
  "GET /api/projects/{project_id}/map": {
    path: { project_id: string };
    query?: { key?: string };
    response: MapIndex;
  };
  "GET /api/projects/{project_id}/map.{ending}": {
    path: { project_id: string; ending: string };
    query?: { crs?: string; raw?: boolean; all_points?: boolean; draft?: boolean };
    response: string;
  };
  "GET /api/projects/{project_id}/map/walk": {
    path: { project_id: string };
    response: MapWalk;
  };
  "GET /api/projects/{project_id}/map/{key}/cubes": {
    path: { project_id: string; key: string };
    query: { stored: "xyz" | "intensity" | "normalized" | "time" | "uncertainty" | "thickness"; version: number; parts: string };
    response: string;
  };
  "GET /api/projects/{project_id}/map/{key}/points": {
    path: { project_id: string; key: string };
    query: { stored: "xyz" | "intensity" | "normalized" | "time" | "uncertainty" | "thickness"; version: number; parts: string };
    response: string;
  };
  "GET /api/projects/{project_id}/map/{key}/sample": {
    path: { project_id: string; key: string };
    query: { stored: "xyz" | "intensity" | "normalized" | "time" | "uncertainty" | "thickness"; version: number };
    response: string;
  };
  "GET /api/projects/{project_id}/notes": {
    path: { project_id: string };
    response: NotesView;
  };
  "GET /api/projects/{project_id}/notes.bcf": {
    path: { project_id: string };
    response: string;
  };
  "GET /api/projects/{project_id}/notes.geojson": {
    path: { project_id: string };
    response: string;
  };
  "GET /api/projects/{project_id}/notes/{note_id}/photo": {
    path: { project_id: string; note_id: string };
    response: string;
  };
  "GET /api/projects/{project_id}/report": {
    path: { project_id: string };
    response: string;
  };
  "GET /api/projects/{project_id}/report.pdf": {
    path: { project_id: string };
    response: string;
  };
  "GET /api/projects/{project_id}/review": {
    path: { project_id: string };
    response: ReviewView;
  };
  "GET /api/projects/{project_id}/review/acknowledgments": {
    path: { project_id: string };
    response: AcknowledgmentsView;
  };
  "GET /api/projects/{project_id}/review/classes": {
    path: { project_id: string };
    response: CorrectionsView;
  };
  "GET /api/projects/{project_id}/review/comments": {
    path: { project_id: string };
    query: { frame_i: number; frame_j: number };
    response: Array<CommentView>;
  };
  "GET /api/projects/{project_id}/review/effect": {
    path: { project_id: string };
    response: Effect | SupersededEffect;
  };
  "GET /api/projects/{project_id}/review/journal": {
    path: { project_id: string };
    query?: { most?: number };
    response: Array<RowView>;
  };
  "GET /api/projects/{project_id}/review/pair": {
    path: { project_id: string };
    query: { frame_i: number; frame_j: number };
    response: PairFacts;
  };
  "GET /api/projects/{project_id}/review/people": {
    path: { project_id: string };
    response: Array<string>;
  };
  "GET /api/projects/{project_id}/review/points": {
    path: { project_id: string };
    query: { reach?: number; frame_i: number; frame_j: number };
    response: any;
  };
  "GET /api/projects/{project_id}/review/queue": {
    path: { project_id: string };
    response: any;
  };
  "GET /api/projects/{project_id}/review/walk": {
    path: { project_id: string };
    response: TrajectoryNodes;
  };
  "GET /api/projects/{project_id}/slices": {
    path: { project_id: string };
    query?: { source?: string; reference?: string };
    response: SliceFacts;
  };
  "GET /api/projects/{project_id}/slices/compare.csv": {
    path: { project_id: string };
    query: { ask: string };
    response: string;
  };
  "GET /api/projects/{project_id}/slices/control": {
    path: { project_id: string };
    response: ControlState;
  };
  "GET /api/projects/{project_id}/slices/control/report": {
    path: { project_id: string };
    response: ControlReport;
  };
  "GET /api/projects/{project_id}/slices/control/report.{ending}": {
    path: { project_id: string; ending: string };
    query?: { draft?: boolean };
    response: any;
  };
  "GET /api/projects/{project_id}/slices/control/site": {
    path: { project_id: string };
    query?: { crs?: string };
    response: SiteTrial;
  };
  "GET /api/projects/{project_id}/slices/control/surface": {
    path: { project_id: string };
    query: { point: string };
    response: SurfacePoint;
  };
  "GET /api/projects/{project_id}/slices/control/targets": {
    path: { project_id: string };
    response: Array<TargetSearch>;
  };
  "GET /api/projects/{project_id}/slices/control/targets/{search_id}": {
    path: { project_id: string; search_id: string };
    response: TargetSearch;
  };
  "GET /api/projects/{project_id}/slices/control/targets/{search_id}/found": {
    path: { project_id: string; search_id: string };
    query?: { crs?: string };
    response: TargetList;
  };
  "GET /api/projects/{project_id}/slices/doubles": {
    path: { project_id: string };
    query?: { source?: string };
    response: DoubleReport;
  };
  "GET /api/projects/{project_id}/slices/export.{ending}": {
    path: { project_id: string; ending: string };
    query: { ask: string };
    response: string;
  };
  "GET /api/projects/{project_id}/slices/overview": {
    path: { project_id: string };
    query?: { source?: string; reference?: string };
    response: string;
  };
  "GET /api/projects/{project_id}/slices/overview/window": {
    path: { project_id: string };
    query?: { source?: string; reference?: string };
    response: WindowSpec;
  };
  "GET /api/projects/{project_id}/slices/references/{reference_id}/points": {
    path: { project_id: string; reference_id: string };
    response: AlignPoints;
  };
  "GET /api/projects/{project_id}/slices/walk": {
    path: { project_id: string };
    query: { start_s: number; end_s: number };
    response: WalkStretch;
  };
  "GET /api/projects/{project_id}/storage": {
    path: { project_id: string };
    response: ProjectStorage;
  };
  "GET /api/projects/{project_id}/thumbnail": {
    path: { project_id: string };
    response: string;
  };
  "GET /api/projects/{project_id}/views": {
    path: { project_id: string };
    response: MapViewsView;
  };
  "GET /api/recordings": {
    query?: { folder?: string };
    response: Array<FolderEntry>;
  };
  "GET /api/rigs": {
    response: Array<RigCard>;
  };
  "GET /api/rigs/{rig_id}": {
    path: { rig_id: string };
    query?: { version?: number | null };
    response: RigView;
  };
  "GET /api/rigs/{rig_id}/versions/{number}/file": {
    path: { rig_id: string; number: string };
    response: string;
  };
  "GET /api/sensor-models": {
    response: Array<SensorModel>;
  };
  "GET /api/server": {
    response: ServerView;
  };
  "GET /api/sessions": {
    response: Array<SessionView>;
  };
  "GET /api/settings": {
    query?: { of?: string };
    response: Array<GroupView>;
  };
  "GET /api/storage": {
    response: StorageView;
  };
  "GET /api/storage/projects": {
    response: Array<ProjectSpace>;
  };
  "GET /api/trash": {
    response: Array<Deleted>;
  };
  "GET /api/uploads": {
    response: Array<UploadView>;
  };
  "GET /api/uploads/{upload_id}": {
    path: { upload_id: string };
    response: UploadView;
  };
  "GET /api/uploads/{upload_id}/files": {
    path: { upload_id: string };
    response: Array<FileView>;
  };
  "GET /api/webhooks": {
    response: Array<Webhook>;
  };
  "GET /api/webhooks/{webhook_id}/deliveries": {
    path: { webhook_id: string };
    response: Array<WebhookDelivery>;
  };
  "GET /api/workers": {
    response: WorkerChoiceView;
  };
  "GET /healthz": {
    response: Record<string, string>;
  };
  "HEAD /api/uploads/files/{file_id}": {
    path: { file_id: string };
    response: any;
  };
  "OPTIONS /api/uploads/files": {
    response: string;
  };
  "PATCH /api/people/{name}": {
    path: { name: string };
    body: Changes;
    response: Account;
  };
  "PATCH /api/projects/{project_id}": {
    path: { project_id: string };
    body: ProjectChanges;
    response: ProjectView;
  };
  "PATCH /api/projects/{project_id}/notes/{note_id}": {
    path: { project_id: string; note_id: string };
    body: NoteChange;
    response: MapNote;
  };
  "PATCH /api/uploads/files/{file_id}": {
    path: { file_id: string };
    response: string;
  };
  "POST /api/guests/open": {
    body: GuestToken;
    response: GuestPlace;
  };
  "POST /api/jobs": {
    body: NewJob;
    response: JobView;
  };
  "POST /api/jobs/{job_id}/cancel": {
    path: { job_id: string };
    response: JobView;
  };
  "POST /api/jobs/{job_id}/retry": {
    path: { job_id: string };
    response: JobView;
  };
  "POST /api/keys": {
    body: NewKey;
    response: KeyView;
  };
  "POST /api/live": {
    body: NewCapture;
    response: CaptureView;
  };
  "POST /api/live/marks": {
    body: NewMark;
    response: Record<string, string>;
  };
  "POST /api/live/pause": {
    response: CaptureView;
  };
  "POST /api/live/process": {
    response: JobView;
  };
  "POST /api/live/resume": {
    response: CaptureView;
  };
  "POST /api/live/stop": {
    response: CaptureView;
  };
  "POST /api/login": {
    body: Credentials;
    response: Me;
  };
  "POST /api/login/again": {
    body: PasswordConfirmation;
    response: Me;
  };
  "POST /api/logout": {
    response: string;
  };
  "POST /api/me/password": {
    body: NewPassword;
    response: Me;
  };
  "POST /api/me/tokens": {
    body: NewAccessToken;
    response: AccessTokenView;
  };
  "POST /api/pairing/approve": {
    body: PairingApproval;
    response: Approved;
  };
  "POST /api/pairing/claim": {
    body: Token;
    response: Me | null;
  };
  "POST /api/pairing/invitations": {
    body: NewInvitation;
    response: InvitationView;
  };
  "POST /api/pairing/redeem": {
    body: Token;
    response: Me;
  };
  "POST /api/pairing/requests": {
    body: NewRequest;
    response: PairingRequestView;
  };
  "POST /api/people": {
    body: NewPerson;
    response: Account;
  };
  "POST /api/projects/{project_id}/calibration/rig": {
    path: { project_id: string };
    body: CalibratedVersion;
    response: SavedRig;
  };
  "POST /api/projects/{project_id}/comparisons": {
    path: { project_id: string };
    body: NewComparison;
    response: ComparisonView;
  };
  "POST /api/projects/{project_id}/comparisons/{comparison_id}/cancel": {
    path: { project_id: string; comparison_id: string };
    response: any;
  };
  "POST /api/projects/{project_id}/exports": {
    path: { project_id: string };
    body: NewExport;
    response: ExportView;
  };
  "POST /api/projects/{project_id}/exports/estimate": {
    path: { project_id: string };
    body: NewExport;
    response: ExportEstimate;
  };
  "POST /api/projects/{project_id}/exports/{export_id}/cancel": {
    path: { project_id: string; export_id: string };
    response: ExportView;
  };
  "POST /api/projects/{project_id}/free": {
    path: { project_id: string };
    body: FreeRequest;
    response: ProjectSpace;
  };
  "POST /api/projects/{project_id}/guests": {
    path: { project_id: string };
    body: NewGuestLink;
    response: NewGuestLinkView;
  };
  "POST /api/projects/{project_id}/map/crs": {
    path: { project_id: string };
    body: PointsInMap;
    response: PointsInCrs;
  };
  "POST /api/projects/{project_id}/map/pick": {
    path: { project_id: string };
    body: RayRequest;
    response: RayHit;
  };
  "POST /api/projects/{project_id}/map/volume": {
    path: { project_id: string };
    body: VolumeRequest;
    response: MapVolume;
  };
  "POST /api/projects/{project_id}/notes": {
    path: { project_id: string };
    body: NewNote;
    response: MapNote;
  };
  "POST /api/projects/{project_id}/remake": {
    path: { project_id: string };
    response: JobView;
  };
  "POST /api/projects/{project_id}/review/acknowledgments": {
    path: { project_id: string };
    body: NewAcknowledgment;
    response: AcknowledgmentsView;
  };
  "POST /api/projects/{project_id}/review/align": {
    path: { project_id: string };
    body: PredictedPose;
    response: AlignmentView;
  };
  "POST /api/projects/{project_id}/review/approve": {
    path: { project_id: string };
    body: Approve;
    response: ReviewView;
  };
  "POST /api/projects/{project_id}/review/classes": {
    path: { project_id: string };
    body: NewCorrection;
    response: CorrectionsView;
  };
  "POST /api/projects/{project_id}/review/classes/count": {
    path: { project_id: string };
    body: CorrectionSpec;
    response: CorrectionCount;
  };
  "POST /api/projects/{project_id}/review/classes/like": {
    path: { project_id: string };
    body: LikeSpec;
    response: AlikeView;
  };
  "POST /api/projects/{project_id}/review/decisions": {
    path: { project_id: string };
    body: NewDecision;
    response: ReviewView;
  };
  "POST /api/projects/{project_id}/review/fit": {
    path: { project_id: string };
    body: PointPairs;
    response: Array<number>;
  };
  "POST /api/projects/{project_id}/review/looking": {
    path: { project_id: string };
    body: Looking;
    response: Array<LookerView>;
  };
  "POST /api/projects/{project_id}/review/redo": {
    path: { project_id: string };
    body: Step;
    response: ReviewView;
  };
  "POST /api/projects/{project_id}/review/undo": {
    path: { project_id: string };
    body: Step;
    response: ReviewView;
  };
  "POST /api/projects/{project_id}/review/work": {
    path: { project_id: string };
    body: NewWork;
    response: ReviewView;
  };
  "POST /api/projects/{project_id}/slices/compare": {
    path: { project_id: string };
    body: CompareRequest;
    response: Comparison;
  };
  "POST /api/projects/{project_id}/slices/control/preview": {
    path: { project_id: string };
    body: ControlFile;
    response: ControlPreview;
  };
  "POST /api/projects/{project_id}/slices/control/site": {
    path: { project_id: string };
    body: SiteSystem;
    response: string;
  };
  "POST /api/projects/{project_id}/slices/control/targets": {
    path: { project_id: string };
    response: TargetSearch;
  };
  "POST /api/projects/{project_id}/slices/control/targets/{search_id}/cancel": {
    path: { project_id: string; search_id: string };
    response: TargetSearch;
  };
  "POST /api/projects/{project_id}/slices/image": {
    path: { project_id: string };
    body: SliceImageRequest;
    response: SliceImageView;
  };
  "POST /api/projects/{project_id}/slices/pick": {
    path: { project_id: string };
    body: PickRequest;
    response: PickView;
  };
  "POST /api/projects/{project_id}/slices/references": {
    path: { project_id: string };
    body: AddReference;
    response: ListedReference;
  };
  "POST /api/projects/{project_id}/slices/references/preview": {
    path: { project_id: string };
    body: ReferenceFile;
    response: ReferencePreview;
  };
  "POST /api/projects/{project_id}/slices/references/{reference_id}/align": {
    path: { project_id: string; reference_id: string };
    body: AlignRequest;
    response: ListedReference;
  };
  "POST /api/projects/{project_id}/views": {
    path: { project_id: string };
    body: NewMapView;
    response: SavedMapView;
  };
  "POST /api/rigs": {
    body: NewRig;
    response: SavedRig;
  };
  "POST /api/rigs/check": {
    body: RigContent;
    response: RigCheck;
  };
  "POST /api/rigs/{rig_id}/versions": {
    path: { rig_id: string };
    body: NewVersion;
    response: SavedRig;
  };
  "POST /api/settings/check": {
    body: Assignments;
    response: SettingsCheck;
  };
  "POST /api/setup": {
    body: FirstAdmin;
    response: Me;
  };
  "POST /api/trash/{deleted_id}/restore": {
    path: { deleted_id: string };
    response: Restored;
  };
  "POST /api/uploads": {
    body: NewUpload;
    response: UploadView;
  };
  "POST /api/uploads/files": {
    response: any;
  };
  "POST /api/webhooks": {
    body: NewWebhook;
    response: NewWebhookView;
  };
  "POST /api/webhooks/{webhook_id}/test": {
    path: { webhook_id: string };
    response: Webhook;
  };
  "POST /api/workers/test": {
    response: WorkerTestView;
  };
  "PUT /api/projects/{project_id}/notes/{note_id}/photo": {
    path: { project_id: string; note_id: string };
    body: NotePhoto;
    response: MapNote;
  };
  "PUT /api/projects/{project_id}/slices/control": {
    path: { project_id: string };
    body: ControlState;
    response: ControlState;
  };
  "PUT /api/workers": {
    body: WorkerChoice;
    response: WorkerChoiceView;
  };
}
