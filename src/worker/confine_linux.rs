//! All that only Linux can do for a worker: Landlock for files, seccomp for the rest, and orphans
//! that come back to whoever has to end them.

use super::readable::{listable, readable};
use super::spec::{Confinement, CoreOrigin, WorkerSpec};
use landlock::{
    ABI, Access, AccessFs, AccessNet, CompatLevel, Compatible, Ruleset, RulesetAttr,
    RulesetCreatedAttr, RulesetError, RulesetStatus, Scope, path_beneath_rules,
};
use rustix::process::{Signal, getpid};
use seccompiler::{
    BpfProgram, SeccompAction, SeccompCmpArgLen as Length, SeccompCmpOp as Compare,
    SeccompCondition, SeccompFilter, SeccompRule,
};
use std::collections::BTreeMap;
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::Command;

/// The newest version of Landlock that this was written for; older kernels do what they can.
const NEWEST: ABI = ABI::V6;

/// Sandboxes this process, for good.
pub(crate) fn sandbox(worker: &WorkerSpec, confinement: &mut Confinement) {
    // A worker does not outlive its bench.
    let _ = rustix::process::set_parent_process_death_signal(Some(Signal::KILL));
    let Confinement { in_force, lacking } = confinement;
    let kernel = |error: String| format!("{error}; this kernel cannot keep it from");
    match shut_files(worker) {
        Ok(RulesetStatus::FullyEnforced) => {
            in_force.push("reads itself and the system's libraries (Landlock)".to_owned());
            in_force.push("writes its scratch folder alone (Landlock)".to_owned());
        }
        Ok(RulesetStatus::PartiallyEnforced) => {
            in_force.push("files: what an older Landlock can".to_owned());
            lacking.push("signals to other processes, cutting off files: newer kernels".to_owned());
        }
        Ok(RulesetStatus::NotEnforced) => lacking.push(kernel("no Landlock".to_owned()) + " files"),
        Err(error) => lacking.push(kernel(format!("Landlock: {error}")) + " files"),
    }
    match shut_calls(&worker.origin) {
        Ok(()) => {
            in_force.push("no network (seccomp)".to_owned());
            in_force.push("no memory but its own (seccomp)".to_owned());
            in_force.push(match worker.origin.may_start_processes() {
                true => "no process leaves its group (seccomp)".to_owned(),
                false => "no processes (seccomp)".to_owned(),
            });
        }
        Err(error) => {
            lacking.push(kernel(format!("seccomp: {error}")) + " the network and processes");
        }
    }
}

/// Reads, writes and signals end at the walls.
fn shut_files(worker: &WorkerSpec) -> Result<RulesetStatus, RulesetError> {
    let all = AccessFs::from_all(NEWEST);
    let scratch = [PathBuf::from("/dev/null"), worker.scratch.clone()];
    let status = Ruleset::default()
        .set_compatibility(CompatLevel::BestEffort)
        .handle_access(all)?
        .handle_access(AccessNet::from_all(NEWEST))?
        .scope(Scope::from_all(NEWEST))?
        .create()?
        .add_rules(path_beneath_rules(readable(worker), AccessFs::from_read(NEWEST)))?
        .add_rules(path_beneath_rules(listable(&worker.origin, &worker.hidden), AccessFs::ReadDir))?
        .add_rules(path_beneath_rules(scratch, all))?
        .restrict_self()?;
    Ok(status.ruleset)
}

/// System calls that answer EPERM, by what they could do.
const FORBIDDEN: &[libc::c_long] = &[
    // The network. Pairs of sockets stay: they reach nobody.
    libc::SYS_socket,
    // Requests that no filter sees.
    libc::SYS_io_uring_setup,
    // Memory that is counted to no process: it would outgrow the limit, and what outlives a process would tell the
    // next trial of it.
    libc::SYS_shmget,
    libc::SYS_shmat,
    libc::SYS_semget,
    libc::SYS_msgget,
    libc::SYS_mq_open,
    libc::SYS_mq_unlink,
    libc::SYS_memfd_create,
    libc::SYS_memfd_secret,
    // Sending open files away: on their way they belong to nobody, and nobody counts them.
    libc::SYS_sendmsg,
    libc::SYS_sendmmsg,
    // Leaving the process group, by which everything is ended.
    libc::SYS_setsid,
    libc::SYS_setpgid,
    // Other processes.
    libc::SYS_ptrace,
    libc::SYS_process_vm_readv,
    libc::SYS_process_vm_writev,
    libc::SYS_pidfd_open,
    libc::SYS_pidfd_getfd,
    libc::SYS_pidfd_send_signal,
    libc::SYS_rt_sigqueueinfo,
    libc::SYS_rt_tgsigqueueinfo,
    // What Landlock does not look at: modes, owners, times and attributes of files.
    libc::SYS_fchmod,
    libc::SYS_fchmodat,
    libc::SYS_fchmodat2,
    libc::SYS_fchown,
    libc::SYS_fchownat,
    libc::SYS_utimensat,
    libc::SYS_setxattr,
    libc::SYS_lsetxattr,
    libc::SYS_fsetxattr,
    libc::SYS_removexattr,
    libc::SYS_lremovexattr,
    libc::SYS_fremovexattr,
    libc::SYS_open_by_handle_at,
    // The machine.
    libc::SYS_mount,
    libc::SYS_umount2,
    libc::SYS_pivot_root,
    libc::SYS_chroot,
    libc::SYS_unshare,
    libc::SYS_setns,
    libc::SYS_bpf,
    libc::SYS_perf_event_open,
    libc::SYS_userfaultfd,
    libc::SYS_keyctl,
    libc::SYS_add_key,
    libc::SYS_request_key,
    libc::SYS_init_module,
    libc::SYS_finit_module,
    libc::SYS_delete_module,
    libc::SYS_kexec_load,
    libc::SYS_reboot,
    libc::SYS_sethostname,
    libc::SYS_settimeofday,
    libc::SYS_clock_settime,
    libc::SYS_setrlimit,
];

/// The same, of calls that only this architecture has.
#[cfg(target_arch = "x86_64")]
const FORBIDDEN_HERE: &[libc::c_long] =
    &[libc::SYS_chmod, libc::SYS_chown, libc::SYS_lchown, libc::SYS_utime, libc::SYS_utimes];
#[cfg(not(target_arch = "x86_64"))]
const FORBIDDEN_HERE: &[libc::c_long] = &[];

/// Starting another program or process: a library has no business there.
const STARTING: &[libc::c_long] = &[libc::SYS_execve, libc::SYS_execveat];
#[cfg(target_arch = "x86_64")]
const STARTING_HERE: &[libc::c_long] = &[libc::SYS_fork, libc::SYS_vfork];
#[cfg(not(target_arch = "x86_64"))]
const STARTING_HERE: &[libc::c_long] = &[];

type Rules = BTreeMap<libc::c_long, Vec<SeccompRule>>;

fn shut_calls(origin: &CoreOrigin) -> Result<(), seccompiler::Error> {
    let mut rules: Rules = unconditional(FORBIDDEN).chain(unconditional(FORBIDDEN_HERE)).collect();
    // Reading a limit and setting it are one call; setting one hands over something.
    let sets_a_limit = condition(2, Length::Qword, Compare::Ne, 0)?;
    rules.insert(libc::SYS_prlimit64, vec![SeccompRule::new(vec![sets_a_limit])?]);
    rules.extend(rules_of_open_files()?);
    if !origin.may_start_processes() {
        rules.extend(unconditional(STARTING).chain(unconditional(STARTING_HERE)));
        for (call, more) in rules_of_a_single_process()? {
            rules.entry(call).or_default().extend(more);
        }
    }
    // Its flags lie in memory, where no filter looks; libraries then fall back on `clone`.
    install(unconditional(&[libc::SYS_clone3]).collect(), libc::ENOSYS)?;
    install(rules, libc::EPERM)
}

fn unconditional(calls: &[libc::c_long]) -> impl Iterator<Item = (libc::c_long, Vec<SeccompRule>)> {
    calls.iter().map(|call| (*call, Vec::new()))
}

/// The bench sees the open files of a process, which are those of all its threads.
fn rules_of_open_files() -> Result<Rules, seccompiler::Error> {
    let [thread, files] = [libc::CLONE_THREAD, libc::CLONE_FILES].map(|flag| flag as u64);
    let apart = condition(0, Length::Qword, Compare::MaskedEq(thread | files), thread)?;
    let hides = condition(0, Length::Dword, Compare::Eq, libc::PR_SET_DUMPABLE as u64)?;
    Ok([
        (libc::SYS_clone, vec![SeccompRule::new(vec![apart])?]),
        (libc::SYS_prctl, vec![SeccompRule::new(vec![hides])?]),
    ]
    .into())
}

/// Threads are no processes; signals go to oneself.
fn rules_of_a_single_process() -> Result<Rules, seccompiler::Error> {
    let thread = libc::CLONE_THREAD as u64;
    let no_thread = condition(0, Length::Qword, Compare::MaskedEq(thread), 0)?;
    let own = getpid().as_raw_nonzero().get().unsigned_abs().into();
    let other = || condition(0, Length::Dword, Compare::Ne, own);
    Ok([
        (libc::SYS_clone, vec![SeccompRule::new(vec![no_thread])?]),
        (libc::SYS_kill, vec![SeccompRule::new(vec![other()?])?]),
        (libc::SYS_tgkill, vec![SeccompRule::new(vec![other()?])?]),
        (libc::SYS_tkill, Vec::new()),
    ]
    .into())
}

fn condition(
    argument: u8,
    length: Length,
    compare: Compare,
    value: u64,
) -> Result<SeccompCondition, seccompiler::Error> {
    Ok(SeccompCondition::new(argument, length, compare, value)?)
}

/// From here on the calls that `rules` match answer `error`.
fn install(rules: Rules, error: i32) -> Result<(), seccompiler::Error> {
    let architecture = std::env::consts::ARCH.try_into()?;
    let answer = SeccompAction::Errno(error.unsigned_abs());
    let filter = SeccompFilter::new(rules, SeccompAction::Allow, answer, architecture)?;
    let program: BpfProgram = filter.try_into()?;
    seccompiler::apply_filter(&program)
}

/// From here on a process whose parent has ended becomes a child of this one, if it descends from
/// it: nothing that a worker started gets away.
pub(crate) fn adopt_orphans() {
    // A kernel that cannot leaves orphans to init, and they are ended all the same.
    let _ = rustix::process::set_child_subreaper(Some(getpid()));
}

/// Lets a program end with whoever starts it: a worker that is killed leaves no renderer behind.
#[expect(unsafe_code, reason = "a system call between fork and exec")]
pub(crate) fn end_with_us(command: &mut Command) {
    let leash = || Ok(rustix::process::set_parent_process_death_signal(Some(Signal::KILL))?);
    // SAFETY: it is one system call, which takes neither locks nor memory.
    unsafe { command.pre_exec(leash) };
}
