import { mount } from "svelte";
import { keepToken } from "./api/token";
import App from "./App.svelte";
import { drive } from "./shared/drive.svelte";
import "./shared/styles/theme.css";
import "./shared/styles/base.css";
import "./shared/styles/controls.css";

// Pictures of the screen and shared addresses must not contain the token.
history.replaceState(history.state, "", keepToken(location.href));
// First, so that an error of the application does not take the emergency stop with it.
void drive.load();
const target = document.getElementById("app");
if (target) mount(App, { target });
