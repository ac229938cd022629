/** A binary message does not follow the format. */
export class FrameError extends Error {}
