import type { Drive } from "../api/warden";
import { describe, EmergencyStop, type StopView } from "./emergency_stop";
import "./styles/stop_bar.css";

/**
 * Adds the bar with the emergency stop to the page, in every view. It is plain DOM, so that no state or error of
 * the application stops it from working.
 */
export function addStopBar({ warden, fleet }: Drive): EmergencyStop {
  const bar = document.createElement("section");
  bar.id = "stop-bar";
  bar.setAttribute("aria-label", "Emergency stop");
  const status = child(bar, "p");
  status.setAttribute("role", "status");
  const stop = new EmergencyStop(warden, (view) => show(bar, status, view));
  bar.prepend(stopButton(stop));
  const link = child(bar, "a");
  link.setAttribute("href", "#/robots");
  link.textContent = `Robots of ${fleet}`;
  document.documentElement.classList.add("has-drive");
  keepOnTop(bar);
  stopOnEscape(stop);
  void stop.watch();
  return stop;
}

function stopButton(stop: EmergencyStop): HTMLButtonElement {
  const button = document.createElement("button");
  button.type = "button";
  button.setAttribute("aria-label", "Emergency stop of all robots");
  button.setAttribute("aria-keyshortcuts", "Escape");
  child(button, "span").textContent = "STOP";
  child(button, "kbd").textContent = "Esc";
  // A press is enough. A click without one is from a keyboard or an assistive technology.
  button.addEventListener("pointerdown", () => stop.request());
  button.addEventListener("click", (event) => event.detail === 0 && stop.request());
  return button;
}

function show(bar: HTMLElement, status: HTMLElement, view: StopView): void {
  const text = describe(view);
  if (status.textContent !== text) status.textContent = text;
  const isUnknown = view.request === "requested" || view.isReachable === false;
  bar.dataset.tone = isUnknown ? "alarm" : view.isLatched ? "latched" : "ready";
}

/** In the capture phase of the window, so that no dialog, field or component can keep the key for itself. */
function stopOnEscape(stop: EmergencyStop): void {
  const press = (event: KeyboardEvent) => event.key === "Escape" && !event.repeat && stop.request();
  addEventListener("keydown", press, { capture: true });
}

/** Everything outside an open modal dialog is inert, so the bar is moved into it and back. */
function keepOnTop(bar: HTMLElement): void {
  const place = () => {
    const parent = [...document.querySelectorAll("dialog:modal")].at(-1) ?? document.body;
    if (bar.parentElement !== parent) parent.prepend(bar);
  };
  new MutationObserver(place).observe(document.body, {
    subtree: true,
    childList: true,
    attributeFilter: ["open"],
  });
  place();
}

function child(parent: HTMLElement, tag: string): HTMLElement {
  return parent.appendChild(document.createElement(tag));
}
