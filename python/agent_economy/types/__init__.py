"""Types of brains, the page and the warden, generated from the Rust types by `make schemas`."""
