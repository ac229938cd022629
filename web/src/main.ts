import { mount } from "svelte";
import App from "./App.svelte";
import { drive } from "./shared/drive.svelte";
import { withoutToken } from "./shared/link";
import "./shared/styles/theme.css";
import "./shared/styles/base.css";
import "./shared/styles/controls.css";

// The token is in a cookie now: pictures of the screen and shared addresses must not contain it.
history.replaceState(history.state, "", withoutToken(location.href));
// First, so that an error of the application does not take the emergency stop with it.
void drive.load();
const target = document.getElementById("app");
if (target) mount(App, { target });
