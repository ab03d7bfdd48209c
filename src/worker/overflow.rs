//! A stack that overflows, told apart from a pointer that leads nowhere: both are a segmentation fault.
//!
//! On Linux, for the thread that asks the core. A fault at the end of its stack ends the process by a signal that nothing
//! else raises; any other ends it as it would without us. Elsewhere nothing is watched, and the words for a segmentation
//! fault leave both open.

/// Whether a segmentation fault of a worker is something else than an overflow.
pub(crate) const IS_WATCHED: bool = cfg!(target_os = "linux");

#[cfg(target_os = "linux")]
pub(crate) use linux::{tells, watch};

#[cfg(target_os = "linux")]
#[expect(unsafe_code, reason = "a signal handler, and the address it is told")]
mod linux {
    use rustix::process::{Resource, getrlimit};
    use std::mem::MaybeUninit;
    use std::ptr;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// What ends a process whose stack has overflowed: the fault of a coprocessor that no machine of today has.
    const SIGNAL: i32 = libc::SIGSTKFLT;
    /// The handler cannot run on the stack that is full. In bytes.
    const OWN_STACK: usize = 1 << 16;
    /// The address of a fault lies so close to the end of the stack, in bytes: frames may be large, and the kernel keeps a
    /// megabyte below the end free.
    const CLOSE: usize = 2 << 20;

    /// The address at which the stack of this thread ends; 0 where it has no limit.
    static END: AtomicUsize = AtomicUsize::new(0);

    /// Whether a process that ended by this signal had a stack that overflowed.
    pub(crate) fn tells(signal: i32) -> bool {
        signal == SIGNAL
    }

    /// From here on an overflow of the stack is told. On the first thread of a process, whose stack has the limit of the
    /// process.
    pub(crate) fn watch() {
        let begin = 0_u8;
        let Some(size) = getrlimit(Resource::Stack).current else { return };
        let end = ptr::from_ref(&begin).addr().saturating_sub(size as usize);
        END.store(end, Ordering::Relaxed);
        let own = Box::leak(Box::new([0_u8; OWN_STACK]));
        let own = libc::stack_t { ss_sp: own.as_mut_ptr().cast(), ss_flags: 0, ss_size: OWN_STACK };
        // SAFETY: all zeros is an action without flags and blocked signals.
        let mut action: libc::sigaction = unsafe { MaybeUninit::zeroed().assume_init() };
        action.sa_sigaction = tell as *const () as usize;
        action.sa_flags = libc::SA_SIGINFO | libc::SA_ONSTACK | libc::SA_RESETHAND;
        // SAFETY: the stack lives as long as the process, and the handler keeps to what a handler may do.
        unsafe {
            libc::sigaltstack(&raw const own, ptr::null_mut());
            libc::sigaction(libc::SIGSEGV, &raw const action, ptr::null_mut());
        }
    }

    /// By now the signal kills again: a fault that is met once more ends the process; one that was raised is raised again.
    extern "C" fn tell(signal: i32, info: *mut libc::siginfo_t, _: *mut libc::c_void) {
        // SAFETY: the kernel hands over what it knows of the signal.
        let (was_raised, address) = unsafe { ((*info).si_code <= 0, (*info).si_addr().addr()) };
        let is_overflow = address.abs_diff(END.load(Ordering::Relaxed)) < CLOSE;
        let ends_by = match (was_raised, is_overflow) {
            (true, _) => signal,
            (false, true) => SIGNAL,
            (false, false) => return,
        };
        // SAFETY: both may be called in a handler.
        unsafe { libc::kill(libc::getpid(), ends_by) };
    }
}

#[cfg(not(target_os = "linux"))]
pub(crate) use elsewhere::*;

#[cfg(not(target_os = "linux"))]
mod elsewhere {
    /// Nothing is watched.
    pub(crate) fn watch() {}

    /// Whether a process that ended by this signal had a stack that overflowed: nobody knows.
    #[cfg(unix)]
    pub(crate) fn tells(_: i32) -> bool {
        false
    }
}
