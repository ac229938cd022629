//! Prints the JSON Schema of the page's messages, from which `make schemas` generates types:
//! `cargo run -p agent-economy-protocol --example page_schema`.

#[expect(clippy::print_stdout, reason = "its output")]
fn main() {
    println!("{:#}", protocol::page_schema());
}
