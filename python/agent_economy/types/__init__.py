"""Types of brains and of the page's messages, generated from the Rust types by `make schemas`."""
