//! The process of a command. A thread writes its questions and another reads its answers, so that a process that reads or writes nothing blocks no caller.

use super::command::CommandLine;
use super::message::{ExternalAnswer, read_answer};
use super::tail::Tail;
use crate::platform::{Instant, spawn};
use crate::task::{Cancelled, Task};
use std::io::{self, BufReader, Write};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

const POLL_INTERVAL: Duration = Duration::from_millis(20);

const STDERR_TIMEOUT: Duration = Duration::from_millis(500);

const EXIT_TIMEOUT: Duration = Duration::from_millis(500);

/// Longest array of an answer before the first question has set a limit, bytes.
const MAX_UNASKED_BYTES: u64 = 1 << 20;

pub struct Process {
    child: Child,
    questions: Option<Sender<Vec<u8>>>,
    answers: Receiver<io::Result<Option<ExternalAnswer>>>,
    stderr: Tail,
    most_bytes: Arc<AtomicU64>,
    /// Number of questions without an answer yet.
    pub pending: u32,
    owner: u32,
    /// Time of the last question asked with nothing pending, or of the last answer.
    since: Instant,
}

/// The reason for a missing answer.
#[derive(Debug)]
pub enum ProcessFailure {
    /// The work was cancelled; the process keeps running.
    Cancelled,
    /// The process can't be used any further.
    Broken(String),
}

impl From<Cancelled> for ProcessFailure {
    fn from(_: Cancelled) -> Self {
        ProcessFailure::Cancelled
    }
}

impl Process {
    /// Starts the command.
    pub fn start(command: &CommandLine) -> io::Result<Process> {
        let [program, arguments @ ..] = command.words.as_slice() else {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the command is empty"));
        };
        let mut to_start = Command::new(program);
        to_start.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        // The process has a group of its own, so that its children end with it.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut to_start, 0);
        let mut child = to_start.spawn()?;
        let (stdin, stdout, stderr) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (questions, asked) = channel::<Vec<u8>>();
        let (said, answers) = channel();
        let (tail, most_bytes) = (Tail::default(), Arc::new(AtomicU64::new(MAX_UNASKED_BYTES)));
        let process = Process {
            child,
            questions: Some(questions),
            answers,
            stderr: tail.clone(),
            most_bytes: most_bytes.clone(),
            pending: 0,
            owner: std::process::id(),
            since: Instant::now(),
        };
        spawn("questions", move || {
            let Some(mut stdin) = stdin else { return };
            // The caller waits for an answer, and so learns that the process ended and reads no more.
            while let Ok(bytes) = asked.recv()
                && stdin.write_all(&bytes).and_then(|()| stdin.flush()).is_ok()
            {}
        })?;
        spawn("answers", move || {
            let Some(mut stdout) = stdout.map(BufReader::new) else { return };
            loop {
                let answer = read_answer(&mut stdout, &|| most_bytes.load(Ordering::Relaxed));
                let is_last = !matches!(answer, Ok(Some(_)));
                if said.send(answer).is_err() || is_last {
                    return;
                }
            }
        })?;
        spawn("last words", move || {
            if let Some(stderr) = stderr {
                tail.follow(stderr);
            }
        })?;
        Ok(process)
    }

    /// Whether this process started the child, and not a parent that this process was forked from.
    pub fn is_ours(&self) -> bool {
        self.owner == std::process::id()
    }

    /// Sends a question; the answer's arrays may have `most_bytes` each.
    pub fn ask(&mut self, question: Vec<u8>, most_bytes: u64) {
        self.most_bytes.fetch_max(most_bytes, Ordering::Relaxed);
        if self.pending == 0 {
            self.since = Instant::now();
        }
        self.pending += 1;
        if let Some(questions) = &self.questions {
            // A thread that ended has seen the process end, which the next wait reports.
            let _sent = questions.send(question);
        }
    }

    /// Waits for the next answer, for at most `limit`.
    /// # Errors
    /// [`ProcessFailure`] where the task is cancelled, and where the process hangs, ended or wrote something else.
    pub fn wait(&mut self, task: &Task, limit: Duration) -> Result<ExternalAnswer, ProcessFailure> {
        loop {
            task.check()?;
            match self.answers.recv_timeout(POLL_INTERVAL) {
                Ok(Ok(Some(answer))) => {
                    self.pending = self.pending.saturating_sub(1);
                    self.since = Instant::now();
                    return Ok(answer);
                }
                Ok(Ok(None)) | Err(RecvTimeoutError::Disconnected) => {
                    let ended = match self.end_within(STDERR_TIMEOUT) {
                        Some(status) => format!("it ended ({status}) before it answered"),
                        None => "it closed its standard output before it answered".to_owned(),
                    };
                    return Err(ProcessFailure::Broken(self.with_last_words(ended, STDERR_TIMEOUT)));
                }
                Ok(Err(error)) => {
                    return Err(ProcessFailure::Broken(self.with_last_words(error.to_string(), STDERR_TIMEOUT / 5)));
                }
                Err(RecvTimeoutError::Timeout) if self.since.elapsed() > limit => {
                    let hangs = format!("it gave no answer within {} s", limit.as_secs_f64());
                    return Err(ProcessFailure::Broken(self.with_last_words(hangs, Duration::ZERO)));
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    /// The child's status where it ends within `wait`.
    fn end_within(&mut self, wait: Duration) -> Option<ExitStatus> {
        let began = Instant::now();
        while began.elapsed() < wait {
            match self.child.try_wait() {
                Ok(None) => std::thread::sleep(POLL_INTERVAL / 4),
                ended => return ended.ok().flatten(),
            }
        }
        None
    }

    /// The reason `why` with the end of the process' standard error, waiting up to `wait` for that end.
    pub fn with_last_words(&self, why: String, wait: Duration) -> String {
        match self.stderr.text(wait) {
            text if text.is_empty() => format!("{why}; it wrote nothing on its standard error"),
            text => format!("{why}; the end of its standard error:\n{text}"),
        }
    }
}

impl Drop for Process {
    /// Closes the process' standard input. A process that waits for a question then has a moment to end by itself.
    fn drop(&mut self) {
        if !self.is_ours() {
            return;
        }
        self.questions = None;
        if self.pending == 0 {
            self.end_within(EXIT_TIMEOUT);
        }
        #[cfg(unix)]
        {
            use rustix::process::{Pid, Signal, kill_process_group};
            // Children of the process may outlive it.
            let _gone = kill_process_group(Pid::from_child(&self.child), Signal::KILL);
        }
        let _gone = self.child.kill();
        let _status = self.child.wait();
    }
}
