//! `Memory`: a column that Python reads through the buffer protocol.

#![allow(unsafe_code)] // the buffer protocol, `madvise` and the garbage collector are C interfaces

use std::ffi::c_int;
use std::ptr;
use std::sync::{Mutex, MutexGuard, PoisonError};

use cobotwire_core::{Cells, Field};
use pyo3::exceptions::PyBufferError;
use pyo3::ffi;
use pyo3::prelude::*;

use crate::column::Column;

/// Numbers in memory that NumPy, Arrow and memoryviews use without a copy.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct Memory {
    held: Mutex<Held>,
}

struct Held {
    column: Column,
    /// The number of elements in a row; 0: the column has one dimension.
    across: isize,
    /// The number of views. While there is a view, the column neither moves nor changes.
    views: usize,
}

/// The arrays that a view refers to while it exists.
struct Shape {
    shape: [isize; 2],
    strides: [isize; 2],
}

impl Memory {
    /// Return a column of offsets in a stream, or of sizes.
    pub fn offsets(all: Vec<u64>) -> Self {
        Self::new(Column::Offsets(all), 0)
    }

    /// Return a column of address bytes.
    pub fn addresses(all: Vec<u8>) -> Self {
        Self::new(Column::Cells(Cells::U8(all)), 0)
    }

    /// Return a column of times.
    pub fn times(all: Vec<i64>) -> Self {
        Self::new(Column::Cells(Cells::I64(all)), 0)
    }

    /// Return a column of a field's numbers; it has two dimensions if the field has several
    /// numbers.
    pub fn cells(cells: Cells, field: &Field) -> Self {
        let numbers = field.cases.first().map_or(0, |case| case.numbers.len());
        let across = if field.many { numbers as isize } else { 0 };
        Self::new(Column::Cells(cells), across)
    }

    fn new(column: Column, across: isize) -> Self {
        Self {
            held: Mutex::new(Held {
                column,
                across,
                views: 0,
            }),
        }
    }

    fn held(&self) -> MutexGuard<'_, Held> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Take the column out, and leave an empty one; fail if a view of it exists.
    pub fn take(&self) -> PyResult<Column> {
        // The lock is held throughout: no view can be made between the check and the replacement.
        let mut held = self.held();
        if held.views > 0 {
            let text = "out is still used by a memoryview or an array";
            return Err(PyBufferError::new_err(text));
        }
        let empty = Column::Offsets(Vec::new());
        Ok(std::mem::replace(&mut held.column, empty))
    }

    fn put_back(&self, column: Column) {
        let mut held = self.held();
        // Views of an empty column refer to no bytes, so they do not prevent its replacement.
        if held.column.is_empty() {
            held.column = column;
        }
    }

    /// Take all columns out; if one of them is in use, put the others back.
    pub fn take_all(memories: &[&Self]) -> PyResult<Vec<Column>> {
        let mut columns = Vec::with_capacity(memories.len());
        for memory in memories {
            match memory.take() {
                Ok(column) => columns.push(column),
                Err(error) => {
                    for (memory, column) in memories.iter().zip(columns) {
                        memory.put_back(column);
                    }
                    return Err(error);
                }
            }
        }
        Ok(columns)
    }
}

#[pymethods]
impl Memory {
    unsafe fn __getbuffer__(
        slf: Bound<'_, Self>,
        view: *mut ffi::Py_buffer,
        flags: c_int,
    ) -> PyResult<()> {
        let refused = |why: &'static str| Err(PyBufferError::new_err(why));
        if view.is_null() {
            return refused("a column needs a view to fill");
        }
        // SAFETY: the caller passes a view to fill. If the request is rejected, `obj` must be null.
        unsafe { (*view).obj = ptr::null_mut() };
        let wanted = |flag: c_int| flags & flag == flag;
        if wanted(ffi::PyBUF_WRITABLE) {
            return refused("a column cannot be written to");
        }
        if wanted(ffi::PyBUF_FORMAT) && !wanted(ffi::PyBUF_ND) {
            return refused("a view with a format needs a shape: without one it is bytes");
        }
        let mut held = slf.get().held();
        let across = held.across;
        let (start, count, size, format) = held.column.parts();
        // No vector is longer than isize::MAX bytes.
        let (count, size) = (count as isize, size as isize);
        let (rows, dimensions) = if across == 0 {
            (count, 1)
        } else {
            (count / across, 2)
        };
        // A column with one row, or with one number in each row, is contiguous in both orders.
        if wanted(ffi::PyBUF_F_CONTIGUOUS) && across > 1 && rows > 1 {
            return refused("the column is in C order, not in Fortran order");
        }
        let shape = Box::new(Shape {
            shape: [rows, across],
            strides: [size * across.max(1), size],
        });
        held.views += 1;
        drop(held);
        // SAFETY: the caller passes a view to fill. The column's memory does not move while `views`
        // counts this view. The shape is freed with the view, which keeps this object alive.
        unsafe {
            let shape = Box::into_raw(shape);
            (*view).buf = start;
            (*view).len = count * size;
            (*view).readonly = 1;
            (*view).itemsize = size;
            (*view).format = if wanted(ffi::PyBUF_FORMAT) {
                format.as_ptr().cast_mut()
            } else {
                ptr::null_mut()
            };
            // Without a shape the view is bytes, which have one dimension.
            (*view).ndim = if wanted(ffi::PyBUF_ND) { dimensions } else { 1 };
            (*view).shape = if wanted(ffi::PyBUF_ND) {
                (&raw mut (*shape).shape).cast()
            } else {
                ptr::null_mut()
            };
            (*view).strides = if wanted(ffi::PyBUF_STRIDES) {
                (&raw mut (*shape).strides).cast()
            } else {
                ptr::null_mut()
            };
            (*view).suboffsets = ptr::null_mut();
            (*view).internal = shape.cast();
            (*view).obj = slf.into_ptr();
        }
        Ok(())
    }

    unsafe fn __releasebuffer__(&self, view: *mut ffi::Py_buffer) {
        self.held().views -= 1;
        // SAFETY: `__getbuffer__` stored this pointer, and a view is released once.
        drop(unsafe { Box::from_raw((*view).internal.cast::<Shape>()) });
    }
}

/// The smallest buffer, in bytes, that large pages speed up.
const LARGE: usize = 4 << 20;

/// Request large pages for memory that is about to be filled: the first access to a small page
/// costs more than decoding its contents.
pub fn large_pages(start: *const u8, size: usize) {
    #[cfg(target_os = "linux")]
    if size >= LARGE {
        const PAGE: usize = 4096;
        let inside = start.align_offset(PAGE);
        // SAFETY: the pages lie within our memory, and the advice does not change their contents.
        unsafe {
            libc::madvise(
                start.wrapping_add(inside).cast_mut().cast(),
                (size - inside) / PAGE * PAGE,
                libc::MADV_HUGEPAGE,
            );
        }
    }
    #[cfg(not(target_os = "linux"))]
    let _ = (start, size);
}

/// Untrack an object that cannot be part of a cycle: otherwise the garbage collector would visit
/// millions of these objects again and again (`docs/speed.md` has the cost).
pub fn untrack<T>(object: &Bound<'_, T>) {
    // SAFETY: the object is complete, and its class supports the collector, as tuples and all classes
    // of PyO3 do. An untracked object is freed like any other.
    unsafe { ffi::PyObject_GC_UnTrack(object.as_ptr().cast()) }
}
