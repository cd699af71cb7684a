//! Answers the tests in Python, one JSON object a line: `codec`, `exchange` or `client`.

fn main() {}
