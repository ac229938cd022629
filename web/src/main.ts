import { mount } from "svelte";
import App from "./App.svelte";
import "./shared/styles/theme.css";
import "./shared/styles/base.css";
import "./shared/styles/controls.css";

const target = document.getElementById("app");
if (target) mount(App, { target });
