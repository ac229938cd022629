import { FrameError } from "./frame_error";
import { type Frame, readFrame } from "./frames";
import { overlayKind, readOverlay, type Told } from "./overlay";
import { type Message, readMessage } from "./messages";
import type { Command } from "./protocol";

/** What of a WebSocket is used; tests put something else in its place. */
export interface Socket {
  binaryType: string;
  onopen: (() => void) | null;
  onclose: (() => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  send(data: string): void;
  close(): void;
}

export interface Wires {
  connect(): Socket;
  /** Calls `action` after so many milliseconds; gives what cancels that. */
  after(ms: number, action: () => void): () => void;
}

export interface Listener {
  /** The line is there: time to say what to open. */
  ready(): void;
  /** The line is gone; it is tried again in so many milliseconds. */
  lost(again_ms: number): void;
  message(message: Message): void;
  frame(frame: Frame): void;
}

const firstWait_ms = 500;
const longestWait_ms = 10_000;

/** A line to the server that comes back by itself until it is closed. */
export class Connection {
  private socket: Socket | null = null;
  private isOpen = false;
  private failures = 0;
  private cancel = () => {};
  /** Lies over the next frame. */
  private overlay: Told | null = null;

  constructor(
    private readonly listener: Listener,
    private readonly wires: Wires = browserWires("ws"),
  ) {}

  /** Connects now, whatever wait is under way. */
  start(): void {
    this.close();
    const socket = this.wires.connect();
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

  /** Says something; false if there is no line. */
  send(command: Command): boolean {
    if (!this.isOpen || !this.socket) return false;
    this.socket.send(JSON.stringify(command));
    return true;
  }

  /** Hangs up for good. */
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
    if (message.type === "opened" || message.type === "studying") this.failures = 0;
    this.listener.message(message);
  }

  private receivedFrame(data: ArrayBuffer): void {
    try {
      this.readBytes(data);
    } catch (fault) {
      if (!(fault instanceof FrameError)) throw fault;
      // Its number is unknown, so it cannot be acknowledged: only a new line goes on.
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
    const isOfIt = overlay?.frame === frame.number;
    this.listener.frame(isOfIt ? { ...frame, overlay: { ...overlay, robots: frame.robots } } : frame);
  }

  private dropped(): void {
    this.isOpen = false;
    this.socket = null;
    const wait = Math.min(longestWait_ms, firstWait_ms * 2 ** this.failures);
    this.failures += 1;
    this.cancel = this.wires.after(wait, () => this.start());
    this.listener.lost(wait);
  }
}

/** The browser's own, to an address of the server. */
export function browserWires(address: string): Wires {
  return {
    connect: () => new WebSocket(new URL(address, location.href)) as unknown as Socket,
    after: (ms, action) => {
      const timer = setTimeout(action, ms);
      return () => clearTimeout(timer);
    },
  };
}
