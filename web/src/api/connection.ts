import { FrameError } from "./frame_error";
import { type Frame, readFrame } from "./frames";
import { overlayKind, readOverlay, type OverlayData } from "./overlay";
import { readMessage } from "./messages";
import type { PageMessage, ServerMessage } from "./protocol";

/** The part of `WebSocket` that is used; tests substitute it. */
export interface Socket {
  binaryType: string;
  onopen: (() => void) | null;
  onclose: (() => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  send(data: string): void;
  close(): void;
}

export interface Transport {
  connect(): Socket;
  /** Calls `action` after `ms` milliseconds; returns a function that cancels it. */
  after(ms: number, action: () => void): () => void;
}

export interface Listener {
  /** The connection is open: time to send the first command. */
  ready(): void;
  /** The connection is lost; the next attempt is in `retry_ms` milliseconds. */
  lost(retry_ms: number): void;
  message(message: ServerMessage): void;
  frame(frame: Frame): void;
}

const minWait_ms = 500;
const maxWait_ms = 10_000;

/** A connection to the server that reconnects until it is closed. */
export class Connection {
  private socket: Socket | null = null;
  private isOpen = false;
  private failures = 0;
  private cancel = () => {};
  /** The overlay of the next frame. */
  private overlay: OverlayData | null = null;

  constructor(
    private readonly listener: Listener,
    private readonly transport: Transport = browserTransport("ws"),
  ) {}

  /** Connects now and cancels any pending attempt. */
  start(): void {
    this.close();
    const socket = this.transport.connect();
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    this.overlay = null;
    socket.onopen = () => {
      this.isOpen = true;
      this.listener.ready();
    };
    socket.onmessage = (event) => this.received(event.data);
    socket.onclose = () => this.dropped();
  }

  /** Sends a command; false if the connection is not open. */
  send(command: PageMessage): boolean {
    if (!this.isOpen || !this.socket) return false;
    this.socket.send(JSON.stringify(command));
    return true;
  }

  /** Closes the connection permanently. */
  close(): void {
    this.cancel();
    this.isOpen = false;
    const socket = this.socket;
    this.socket = null;
    if (!socket) return;
    socket.onopen = socket.onclose = socket.onmessage = null;
    socket.close();
  }

  private received(data: unknown): void {
    if (typeof data === "string") this.receivedText(data);
    else if (data instanceof ArrayBuffer) this.receivedFrame(data);
  }

  private receivedText(text: string): void {
    const message = readMessage(text);
    if (!message) return;
    if (message.type === "opened" || message.type === "study_progress") this.failures = 0;
    this.listener.message(message);
  }

  private receivedFrame(data: ArrayBuffer): void {
    try {
      this.readBytes(data);
    } catch (error) {
      if (!(error instanceof FrameError)) throw error;
      // The frame number is unknown, so the frame cannot be acknowledged: only a new connection helps.
      this.close();
      this.dropped();
    }
  }

  private readBytes(data: ArrayBuffer): void {
    if (data.byteLength >= 4 && new Uint32Array(data, 0, 1)[0] === overlayKind) {
      this.overlay = readOverlay(data);
      return;
    }
    const [frame, { overlay }] = [readFrame(data), this];
    this.overlay = null;
    const isSameFrame = overlay?.frame === frame.number;
    this.listener.frame(isSameFrame ? { ...frame, overlay: { ...overlay, robots: frame.robots } } : frame);
  }

  private dropped(): void {
    this.isOpen = false;
    this.socket = null;
    const wait = Math.min(maxWait_ms, minWait_ms * 2 ** this.failures);
    this.failures += 1;
    this.cancel = this.transport.after(wait, () => this.start());
    this.listener.lost(wait);
  }
}

/** WebSockets of the browser, to an address of the server. */
export function browserTransport(address: string): Transport {
  return {
    connect: () => new WebSocket(new URL(address, location.href)) as unknown as Socket,
    after: (ms, action) => {
      const timer = setTimeout(action, ms);
      return () => clearTimeout(timer);
    },
  };
}
