// What the pages request of the server, one function for each operation.

export {
  ApiError,
  LIVE_URL as liveUrl,
  changeHeaders,
  GUEST_ENDED,
  isGuest,
  isSignedIn,
  readCurrentUser,
} from "./http.js";
export * from "./api/people.js";
export * from "./api/projects.js";
export * from "./api/guests.js";
export * from "./api/exports.js";
export * from "./api/uploads.js";
export * from "./api/review.js";
export * from "./api/phones.js";
export * from "./api/live.js";
export * from "./api/map.js";
export * from "./api/comparisons.js";
export * from "./api/annotations.js";
export * from "./api/slices.js";
export * from "./api/targets.js";
export * from "./api/rigs.js";
export * from "./api/job_stream.js";
