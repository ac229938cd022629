const isDark = matchMedia("(prefers-color-scheme: dark)").matches;
for (const [name, chart] of Object.entries(charts)) {
  const place = document.getElementById(name);
  vegaEmbed(place, chart, {
    actions: false,
    renderer: "svg",
    tooltip: { theme: isDark ? "dark" : "light" },
    config: {
      axisY: { labelLimit: Math.max(90, 0.36 * place.clientWidth) },
      legend: place.clientWidth < 480 ? { columns: 1 } : {},
    },
  }).then(({ view }) => chart.params && place.before(scaleSwitch(view)));
}
// The charts are scaled to the contenders; a switch shows all teams.
function scaleSwitch(view) {
  const group = document.createElement("div");
  group.className = "switch";
  group.role = "group";
  group.ariaLabel = "Scale";
  for (const name of ["All teams", "Contenders"]) {
    const button = document.createElement("button");
    button.textContent = name;
    button.ariaPressed = name === "Contenders";
    button.onclick = () => {
      for (const each of group.children) each.ariaPressed = each === button;
      view.signal("all_teams", name === "All teams").runAsync();
    };
    group.append(button);
  }
  return group;
}
// Folded tables are printed open.
const folded = () => document.querySelectorAll("details:not([open])");
addEventListener("beforeprint", () => {
  for (const each of folded()) {
    each.dataset.folded = "";
    each.open = true;
  }
});
addEventListener("afterprint", () => {
  for (const each of document.querySelectorAll("details[data-folded]")) {
    each.open = false;
    delete each.dataset.folded;
  }
});
