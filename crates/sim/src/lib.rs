//! The metric simulator: metres, seconds, joules, and sensors that miss.
