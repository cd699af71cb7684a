//! Ports: what a blocking client reads and writes.

use std::io::{self, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

use crate::Error;

/// The scheme before the host and port of a TCP port.
pub(crate) const SOCKET: &str = "socket://";
pub(crate) const CONNECT: Duration = Duration::from_secs(5);

/// A stream of bytes to a device. The time of a read can be limited.
///
/// If no byte comes in time, `read` returns `ErrorKind::WouldBlock` or `ErrorKind::TimedOut`, and
/// so does `write_some` if the stream is full. A `read` of 0 bytes means that the peer has closed
/// the stream.
pub trait Port: Read + Write + Send {
    /// Limit the time of the next `read`, or wait here for bytes for at most that time. A limit of
    /// zero holds until the next call of this method: `read` and `write_some` return at once.
    /// `write_some` is called only while the limit is zero.
    fn wait_at_most(&mut self, longest: Duration) -> io::Result<()>;

    /// Write some of the bytes at once, and return how many; by default, with `write`.
    fn write_some(&mut self, data: &[u8]) -> io::Result<usize> {
        self.write(data)
    }

    /// Wait until what was written is sent, before the port is closed; by default, with `flush`.
    fn finish(&mut self) -> io::Result<()> {
        self.flush()
    }
}

impl Port for TcpStream {
    fn wait_at_most(&mut self, longest: Duration) -> io::Result<()> {
        if longest.is_zero() {
            return self.set_nonblocking(true);
        }
        #[cfg(unix)]
        {
            use rustix::event::{PollFd, PollFlags, Timespec, poll};
            // `poll` waits as exactly as the system allows, and is one system call.
            let longest = Timespec::try_from(longest).map_err(io::Error::other)?;
            let ready = poll(&mut [PollFd::new(self, PollFlags::IN)], Some(&longest))?;
            (ready > 0)
                .then_some(())
                .ok_or(io::ErrorKind::TimedOut.into())
        }
        #[cfg(not(unix))]
        self.set_nonblocking(false)
            .and_then(|()| self.set_read_timeout(Some(longest)))
    }
}

#[cfg(feature = "serial")]
impl Port for Box<dyn serialport::SerialPort> {
    fn wait_at_most(&mut self, longest: Duration) -> io::Result<()> {
        // On Windows, a time of zero means no limit.
        let shortest = Duration::from_millis(u64::from(cfg!(windows)));
        Ok(self.set_timeout(longest.max(shortest))?)
    }

    fn write_some(&mut self, data: &[u8]) -> io::Result<usize> {
        // `write` waits within the limit until the driver takes bytes, and then without a limit
        // until it has taken all. A driver that takes any bytes takes 32 at once.
        self.write(data.get(..32).unwrap_or(data))
    }

    fn finish(&mut self) -> io::Result<()> {
        // A flush would wait without limit if the peer takes no bytes.
        for _ in 0..1000 {
            if self.bytes_to_write()? == 0 {
                return Ok(());
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        // If bytes are unsent, the system waits for them when the port is closed.
        self.clear(serialport::ClearBuffer::Output)?;
        Err(io::ErrorKind::TimedOut.into())
    }
}

impl<P: Port + ?Sized> Port for Box<P> {
    fn wait_at_most(&mut self, longest: Duration) -> io::Result<()> {
        (**self).wait_at_most(longest)
    }

    fn write_some(&mut self, data: &[u8]) -> io::Result<usize> {
        (**self).write_some(data)
    }

    fn finish(&mut self) -> io::Result<()> {
        (**self).finish()
    }
}

pub(crate) fn not_opened(url: &str, error: impl std::fmt::Display) -> Error {
    Error::link(url, &format!("cannot be opened: {error}"), Some(0))
}

/// Open a serial port, or connect to `socket://host:port`.
pub(crate) fn open(url: &str, baudrate: u32) -> Result<Box<dyn Port>, Error> {
    let Some(address) = url.strip_prefix(SOCKET) else {
        #[cfg(feature = "serial")]
        return match serialport::new(url, baudrate).open() {
            Ok(port) => Ok(Box::new(port)),
            Err(error) => Err(not_opened(url, error)),
        };
        #[cfg(not(feature = "serial"))]
        return Err(Error::usage(format!(
            "{url} is a serial port of {baudrate} baud, which needs the feature serial of cobotwire"
        )));
    };
    let failed = |error| not_opened(url, error);
    let none = Err(io::Error::other("the name has no address"));
    let sockets = address.to_socket_addrs().map_err(failed)?;
    let stream = sockets.fold(none, |tried, socket| {
        tried.or_else(|_| TcpStream::connect_timeout(&socket, CONNECT))
    });
    let ready = stream.and_then(|stream| stream.set_nodelay(true).map(|()| stream));
    Ok(Box::new(ready.map_err(failed)?))
}
