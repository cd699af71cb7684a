//! What generated modules are made of: macros state each command once, and make its request, its
//! blocking method and its asynchronous method.

use std::sync::{Arc, OnceLock};

use cobotwire_table::Edition;

use crate::Error;
pub use crate::value::{Typed, Value};

/// The table of an edition.
pub type Table = Arc<Edition>;
/// A table that is read once.
pub type Once = OnceLock<Result<Table, Error>>;

/// Return a table; it is read on first use.
pub fn read(once: &Once, text: &str) -> Result<Table, Error> {
    once.get_or_init(|| crate::read_table(text.as_bytes()))
        .clone()
}

/// A request of a command, as a type.
pub trait Request: Clone + Send + 'static {
    /// What a call returns.
    type Reply: Typed + Send + 'static;
    /// The name of the command.
    const COMMAND: &'static str;
    /// The fields of the reply that the result is made of.
    const RESULTS: &'static [&'static str];
    /// The arguments and results in radians, which the wire carries in degrees.
    const RADIANS: &'static [&'static str];

    /// Return the arguments with their names.
    fn arguments(self) -> Vec<(&'static str, Value)>;
}

/// A message that the device sends without a request, as a type.
pub trait DeviceEvent: Typed + Send + 'static {
    /// The name of the command.
    const COMMAND: &'static str;
    /// Its fields.
    const FIELDS: &'static [&'static str];
}

/// Return the name that a protocol has for an identifier: keywords have additions.
pub(crate) fn plain(name: &str) -> &str {
    match name.strip_suffix('_') {
        Some(keyword @ ("Self" | "crate" | "self" | "super")) => keyword,
        _ => name.strip_prefix("r#").unwrap_or(name),
    }
}

/// Makes the clients of an edition, and a request type and two methods for each command.
#[macro_export]
macro_rules! client {
    (
        $(#[$doc:meta])* $client:ident $asynchronous:ident = $table:expr;
        $($(#[$about:meta])* $message:ident $command:literal $method:ident
            ($($argument:ident: $type:ty),*)
            $(-> $reply:ty = $($result:ident)+)? $(, in radians $($radians:ident)+)?;)*
    ) => {
        /// Return the edition's table; it is read on first use.
        pub fn edition() -> ::std::result::Result<$crate::typed::Table, $crate::Error> {
            static READ: $crate::typed::Once = $crate::typed::Once::new();
            $crate::typed::read(&READ, $table)
        }

        /// The requests, a type for each command.
        pub mod messages {
            use super::*;
            $(
                $(#[$about])*
                #[derive(Clone, Debug, PartialEq)]
                pub struct $message {
                    $(#[allow(missing_docs)] pub $argument: $type,)*
                }

                impl $crate::typed::Request for $message {
                    type Reply = $crate::either!($($reply)?);
                    const COMMAND: &'static str = $command;
                    const RESULTS: &'static [&'static str] = &[$($(stringify!($result)),+)?];
                    const RADIANS: &'static [&'static str] = &[$($(stringify!($radians)),+)?];

                    fn arguments(self) -> ::std::vec::Vec<(&'static str, $crate::Value)> {
                        vec![$((
                            stringify!($argument),
                            $crate::typed::Typed::into_value(self.$argument),
                        )),*]
                    }
                }
            )*
        }

        $crate::blocking_client! {
            [$(#[$doc])*] $client;
            $([$(#[$about])*] $message $method($($argument: $type),*) [$($reply)?];)*
        }
        $crate::asynchronous_client! {
            [$(#[$doc])*] $asynchronous;
            $([$(#[$about])*] $message $method($($argument: $type),*) [$($reply)?];)*
        }
    };
}

/// Makes the blocking client of an edition.
#[doc(hidden)]
#[macro_export]
macro_rules! blocking_client {
    ($doc:tt $client:ident; $($commands:tt)*) => {
        $crate::client_type! { $doc $client $crate::Client; $crate::Port; blocking }
        $crate::methods! { blocking $client; $($commands)* }
    };
}

/// Makes the asynchronous client of an edition.
#[cfg(feature = "tokio")]
#[doc(hidden)]
#[macro_export]
macro_rules! asynchronous_client {
    ($doc:tt $client:ident; $($commands:tt)*) => {
        $crate::client_type! { $doc $client $crate::AsyncClient; $crate::ByteStream; async await }
        $crate::methods! { asynchronous $client; $($commands)* }
    };
}

/// Makes nothing: the feature `tokio` is off.
#[cfg(not(feature = "tokio"))]
#[doc(hidden)]
#[macro_export]
macro_rules! asynchronous_client {
    ($($any:tt)*) => {};
}

/// Makes the type of a client, with what all clients have.
#[doc(hidden)]
#[macro_export]
macro_rules! client_type {
    ([$(#[$doc:meta])*] $client:ident $inner:ty; $port:path; $($kind:ident)+) => {
        $(#[$doc])*
        ///
        /// A clone is a second handle of the same connection.
        #[derive(Clone, Debug)]
        pub struct $client($inner);

        impl ::std::ops::Deref for $client {
            type Target = $inner;

            fn deref(&self) -> &$inner {
                &self.0
            }
        }

        impl $client {
            $crate::openers! { $inner; $($kind)+ }

            /// Drive an arm over an open port; an asynchronous one is served by the present runtime.
            pub fn over(
                port: impl $port + 'static,
                options: $crate::Options,
            ) -> ::std::result::Result<Self, $crate::Error> {
                <$inner>::over(edition()?, port, options).map(Self)
            }

            /// Return this client for another address, by its name or number.
            pub fn at(&self, address: &str) -> ::std::result::Result<Self, $crate::Error> {
                self.0.at(address).map(Self)
            }

            /// Return this client so that requests without a reply wait for their acknowledgement.
            #[must_use]
            pub fn acknowledged(&self, within: ::std::time::Duration) -> Self {
                Self(self.0.acknowledged(within))
            }
        }
    };
}

/// Makes the functions that open a port.
#[doc(hidden)]
#[macro_export]
macro_rules! openers {
    ($inner:ty; blocking) => { $crate::openers! { $inner; [] [] } };
    ($inner:ty; async await) => { $crate::openers! { $inner; [async] [.await] } };
    ($inner:ty; [$($async:tt)*] [$($await:tt)*]) => {
        /// Open an arm at `socket://host:port`; a blocking client also at a serial port.
        pub $($async)* fn open(port: &str) -> ::std::result::Result<Self, $crate::Error> {
            Self::open_with(port, $crate::Options::default()) $($await)*
        }

        /// Open an arm with other options.
        pub $($async)* fn open_with(
            port: &str,
            options: $crate::Options,
        ) -> ::std::result::Result<Self, $crate::Error> {
            <$inner>::open(edition()?, port, options) $($await)* .map(Self)
        }
    };
}

/// Makes a method for each command.
#[doc(hidden)]
#[macro_export]
macro_rules! methods {
    (blocking $client:ident; $($command:tt $message:ident $method:ident $rest:tt $reply:tt;)*) => {
        impl $client {
            $($crate::method! { [] [] $command $message $method $rest $reply })*
        }
    };
    (asynchronous $client:ident; $($command:tt $message:ident $method:ident $rest:tt $reply:tt;)*) => {
        impl $client {
            $($crate::method! { [async] [.await] $command $message $method $rest $reply })*
        }
    };
}

/// Makes a method.
#[doc(hidden)]
#[macro_export]
macro_rules! method {
    ([$($async:tt)*] [$($await:tt)*] [$(#[$about:meta])*] $message:ident $method:ident
        ($($argument:ident: $type:ty),*) [$($reply:ty)?]) => {
        $(#[$about])*
        pub $($async)* fn $method(
            &self,
            $($argument: impl ::std::convert::Into<$type>),*
        ) -> ::std::result::Result<$crate::either!($($reply)?), $crate::Error> {
            self.0.call(messages::$message { $($argument: $argument.into()),* }) $($await)*
        }
    };
}

/// Expands to a type, or to the unit type.
#[doc(hidden)]
#[macro_export]
macro_rules! either {
    () => {
        ()
    };
    ($type:ty) => {
        $type
    };
}

/// Makes an enum of the choices of a number.
#[macro_export]
macro_rules! choices {
    ($(#[$doc:meta])* $name:ident { $($(#[$about:meta])* $choice:ident = $raw:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(i64)]
        pub enum $name {
            $($(#[$about])* $choice = $raw,)*
        }

        impl $crate::typed::Typed for $name {
            fn into_value(self) -> $crate::Value {
                $crate::Value::Integer(self as i64)
            }

            fn from_value(value: $crate::Value) -> ::std::option::Option<Self> {
                match value {
                    $($crate::Value::Integer($raw) => ::std::option::Option::Some(Self::$choice),)*
                    _ => ::std::option::Option::None,
                }
            }
        }
    };
}

/// Makes a struct of a row of values; with `as`, it can be passed where a call takes an array.
#[macro_export]
macro_rules! row {
    ($(#[$doc:meta])* $name:ident as [$item:ty; $count:literal]
        { $($(#[$about:meta])* $field:ident: $type:ty,)* }) => {
        $crate::row! { $(#[$doc])* $name { $($(#[$about])* $field: $type,)* } }

        impl ::std::convert::From<$name> for [$item; $count] {
            fn from(row: $name) -> Self {
                [$(row.$field as $item),*]
            }
        }
    };
    ($(#[$doc:meta])* $name:ident { $($(#[$about:meta])* $field:ident: $type:ty,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name {
            $($(#[$about])* pub $field: $type,)*
        }

        impl $crate::typed::Typed for $name {
            fn into_value(self) -> $crate::Value {
                $crate::Value::Row(vec![$($crate::typed::Typed::into_value(self.$field)),*])
            }

            fn from_value(value: $crate::Value) -> ::std::option::Option<Self> {
                let row = <::std::vec::Vec<$crate::Value> as $crate::typed::Typed>::from_value(value);
                let mut row = row?.into_iter();
                ::std::option::Option::Some(Self {
                    $($field: $crate::typed::Typed::from_value(row.next()?)?,)*
                })
            }
        }
    };
}

/// Makes a struct of a message that the device sends without a request.
#[macro_export]
macro_rules! event {
    ($(#[$doc:meta])* $name:ident = $command:literal
        { $($(#[$about:meta])* $field:ident: $type:ty,)* }) => {
        $crate::row! { $(#[$doc])* $name { $($(#[$about])* $field: $type,)* } }

        impl $crate::typed::DeviceEvent for $name {
            const COMMAND: &'static str = $command;
            const FIELDS: &'static [&'static str] = &[$(stringify!($field)),*];
        }
    };
}
