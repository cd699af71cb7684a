//! Compare a call over TCP with a bare round trip of the same bytes; one run alternates between
//! both.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::time::{Duration, Instant};

use cobotwire::Options;
use cobotwire::editions::mycobot280::MyCobot280;

const REQUEST: [u8; 5] = [0xFE, 0xFE, 0x02, 0x20, 0xFA];
const REPLY: [u8; 17] = [
    0xFE, 0xFE, 0x0E, 0x20, 0, 0x8C, 0, 0x3D, 0xFF, 0xE6, 0xFF, 0x3F, 0, 0xAF, 0xFF, 0x51, 0xFA,
];
const CALLS: u32 = 500;
const ROUNDS: usize = 40;

/// Reply to each request until the client disconnects.
fn serve(listener: &TcpListener) -> std::io::Result<()> {
    loop {
        let (mut stream, _) = listener.accept()?;
        stream.set_nodelay(true)?;
        std::thread::spawn(move || {
            let mut request = [0; REQUEST.len()];
            while stream.read_exact(&mut request).is_ok() && stream.write_all(&REPLY).is_ok() {}
        });
    }
}

/// Return the time of one call, the average of many.
fn timed<E>(mut call: impl FnMut() -> Result<(), E>) -> Result<Duration, E> {
    let start = Instant::now();
    for _ in 0..CALLS {
        call()?;
    }
    Ok(start.elapsed() / CALLS)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let listener = TcpListener::bind("127.0.0.1:0")?;
    let address = listener.local_addr()?;
    std::thread::spawn(move || serve(&listener));
    let mut bare = TcpStream::connect(address)?;
    bare.set_nodelay(true)?;
    let arm = MyCobot280::open_with(&format!("socket://{address}"), Options::default())?;
    let (mut floors, mut calls) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        floors.push(timed(|| {
            let mut reply = [0; REPLY.len()];
            bare.write_all(&REQUEST)
                .and_then(|()| bare.read_exact(&mut reply))
        })?);
        calls.push(timed(|| arm.get_angles().map(drop))?);
    }
    floors.sort();
    calls.sort();
    let middle = |times: &[Duration]| times.get(ROUNDS / 2).copied().unwrap_or_default();
    let (floor, call) = (middle(&floors), middle(&calls));
    let ratio = call.as_secs_f64() / floor.as_secs_f64();
    println!("bare {floor:?}, call {call:?}, ratio {ratio:.2}");
    Ok(arm.close()?)
}
