/** Why controls of a live run are disabled. */
export const whyLive =
  "This run is driven by real robots: here it can be neither paused, moved in time nor changed.";
