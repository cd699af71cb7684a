//! Ports: what a blocking client reads and writes.

use std::io::{Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

use crate::Error;

pub(crate) const CONNECT: Duration = Duration::from_secs(5);

/// A stream of bytes to a device, of which reading and writing can be limited in time.
///
/// When the time is over, `read` and `write` return `ErrorKind::WouldBlock` or
/// `ErrorKind::TimedOut`. A `read` of 0 bytes says that the peer has closed the stream.
pub trait Port: Read + Write + Send {
    /// Limit each `read` and `write` from now on; zero: they return at once.
    fn wait_at_most(&mut self, longest: Duration) -> std::io::Result<()>;

    /// Return whether the port takes bytes now. The default says that it does, so that a call with
    /// a deadline finds that out by writing.
    fn has_room(&mut self) -> bool {
        true
    }
}

impl Port for TcpStream {
    fn wait_at_most(&mut self, longest: Duration) -> std::io::Result<()> {
        self.set_nonblocking(longest.is_zero())?;
        if longest.is_zero() {
            return Ok(());
        }
        self.set_read_timeout(Some(longest))?;
        self.set_write_timeout(Some(longest))
    }

    #[cfg(unix)]
    fn has_room(&mut self) -> bool {
        use rustix::event::{PollFd, PollFlags, Timespec, poll};
        let now = Timespec {
            tv_sec: 0,
            tv_nsec: 0,
        };
        let mut polled = [PollFd::new(self, PollFlags::OUT)];
        poll(&mut polled, Some(&now)).map_or(true, |ready| ready > 0)
    }
}

/// A TCP stream that changes its limit without a call of the system: a client does that with each
/// request.
#[cfg(unix)]
struct Tcp {
    stream: TcpStream,
    at_once: bool,
    longest: Duration,
}

#[cfg(unix)]
impl Read for Tcp {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        use rustix::net::{RecvFlags, recv};
        if self.at_once {
            return Ok(recv(&self.stream, buffer, RecvFlags::DONTWAIT)?.0);
        }
        self.stream.read(buffer)
    }
}

#[cfg(unix)]
impl Write for Tcp {
    fn write(&mut self, data: &[u8]) -> std::io::Result<usize> {
        use rustix::net::{SendFlags, send};
        let flags = if self.at_once {
            SendFlags::DONTWAIT
        } else {
            SendFlags::empty()
        };
        Ok(send(&self.stream, data, flags | SendFlags::NOSIGNAL)?)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[cfg(unix)]
impl Port for Tcp {
    fn wait_at_most(&mut self, longest: Duration) -> std::io::Result<()> {
        self.at_once = longest.is_zero();
        if !self.at_once && self.longest != longest {
            self.stream.wait_at_most(longest)?;
            self.longest = longest;
        }
        Ok(())
    }

    fn has_room(&mut self) -> bool {
        self.stream.has_room()
    }
}

#[cfg(feature = "serial")]
impl Port for Box<dyn serialport::SerialPort> {
    fn wait_at_most(&mut self, longest: Duration) -> std::io::Result<()> {
        // On Windows, no time at all means any time.
        let shortest = Duration::from_millis(u64::from(cfg!(windows)));
        Ok(self.set_timeout(longest.max(shortest))?)
    }
}

/// The most bytes that are written at once. A driver that is ready takes them without a wait.
#[cfg(feature = "serial")]
const PIECE: usize = 32;

/// A serial port that neither writes nor flushes without limit.
#[cfg(feature = "serial")]
struct Serial(Box<dyn serialport::SerialPort>);

#[cfg(feature = "serial")]
impl Read for Serial {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.0.read(buffer)
    }
}

#[cfg(feature = "serial")]
impl Write for Serial {
    fn write(&mut self, data: &[u8]) -> std::io::Result<usize> {
        // It waits within its limit until the line takes bytes, then for all of them.
        self.0.write(data.get(..PIECE).unwrap_or(data))
    }

    fn flush(&mut self) -> std::io::Result<()> {
        let begun = std::time::Instant::now();
        while self.0.bytes_to_write()? > 0 {
            if begun.elapsed() > Duration::from_secs(1) {
                // Or the system would wait for the line when the port is closed.
                self.0.clear(serialport::ClearBuffer::Output)?;
                return Err(std::io::ErrorKind::TimedOut.into());
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        Ok(())
    }
}

#[cfg(feature = "serial")]
impl Port for Serial {
    fn wait_at_most(&mut self, longest: Duration) -> std::io::Result<()> {
        self.0.wait_at_most(longest)
    }
}

impl<P: Port + ?Sized> Port for Box<P> {
    fn wait_at_most(&mut self, longest: Duration) -> std::io::Result<()> {
        (**self).wait_at_most(longest)
    }

    fn has_room(&mut self) -> bool {
        (**self).has_room()
    }
}

/// Return host and port of `socket://host:port`; `None`: it is another kind of port.
pub(crate) fn socket_of(url: &str) -> Option<&str> {
    url.strip_prefix("socket://")
}

/// Open a serial port, or connect to `socket://host:port`.
pub(crate) fn open(url: &str, baudrate: u32) -> Result<Box<dyn Port>, Error> {
    let failed =
        |error: std::io::Error| Error::link(url, &format!("cannot be opened: {error}"), Some(0));
    let Some(address) = socket_of(url) else {
        return open_serial(url, baudrate);
    };
    let mut last = std::io::Error::other("the name has no address");
    for socket in address.to_socket_addrs().map_err(failed)? {
        match TcpStream::connect_timeout(&socket, CONNECT) {
            Ok(stream) => {
                stream.set_nodelay(true).map_err(failed)?;
                #[cfg(unix)]
                let stream = Tcp {
                    stream,
                    at_once: false,
                    longest: Duration::ZERO,
                };
                return Ok(Box::new(stream));
            }
            Err(error) => last = error,
        }
    }
    Err(failed(last))
}

#[cfg(feature = "serial")]
fn open_serial(url: &str, baudrate: u32) -> Result<Box<dyn Port>, Error> {
    let opened = serialport::new(url, baudrate).open();
    let port =
        opened.map_err(|error| Error::link(url, &format!("cannot be opened: {error}"), Some(0)))?;
    Ok(Box::new(Serial(port)))
}

#[cfg(not(feature = "serial"))]
fn open_serial(url: &str, _: u32) -> Result<Box<dyn Port>, Error> {
    Err(Error::usage(format!(
        "{url} is a serial port, which needs the feature serial of the crate cobotwire"
    )))
}
