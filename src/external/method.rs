//! External commands as reconstruction methods.

use super::command::CommandLine;
use super::message::{self, AnswerHeader, ExternalAnswer, Map};
use super::process::{Process, ProcessFailure};
use crate::maps::{LogMap, RangeAngleMap};
use crate::radar::Radar;
use crate::reconstruct::{Family, MethodInfo, ReconstructError, Reconstruction, Reconstructor, Request, Weights};
use crate::signal::TwoEnds;
use crate::task::Task;
use std::io;
use std::sync::{Mutex, MutexGuard, TryLockError};
use std::time::Duration;

const USUAL_ETA: f32 = 0.9;

const MAX_NAME_CHARACTERS: usize = 40;

const MAX_TEXT_CHARACTERS: usize = 400;

const POLL_INTERVAL: Duration = Duration::from_millis(5);

/// The reason why a command can't be a method.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // The messages name every field.
pub enum StartError {
    #[error("{command}: it can't be started: {source}")]
    System { command: String, source: io::Error },
    /// The command gave no valid answer: it hangs, it ended, or it wrote something else.
    #[error("{command}: {reason}")]
    NoMethod { command: String, reason: String },
}

/// A method that a process of its own computes, one request at a time.
pub struct ExternalMethod {
    command: CommandLine,
    info: MethodInfo,
    weights: Option<Weights>,
    limit: Duration,
    process: Mutex<State>,
}

struct State {
    process: Option<Process>,
    asked: u64,
}

/// Starts a command and asks for its name. Starting and each answer may take `limit`. `task` stops the start.
/// # Errors
/// [`StartError`] with the end of the process' standard error.
pub fn start(command: CommandLine, limit: Duration, task: &Task) -> Result<ExternalMethod, StartError> {
    let fails = |reason: String| StartError::NoMethod { command: command.to_string(), reason };
    let mut process =
        Process::start(&command).map_err(|source| StartError::System { command: command.to_string(), source })?;
    let line = greeted(&mut process, task, limit).map_err(|failure| match failure {
        ProcessFailure::Cancelled => fails("cancelled".to_owned()),
        ProcessFailure::Broken(reason) => fails(reason),
    })?;
    let (info, weights) = who(line).map_err(|why| fails(process.with_last_words(why, Duration::ZERO)))?;
    let state = State { process: Some(process), asked: 0 };
    Ok(ExternalMethod { command, info, weights, limit, process: Mutex::new(state) })
}

fn greeted(process: &mut Process, task: &Task, limit: Duration) -> Result<AnswerHeader, ProcessFailure> {
    process.ask(message::hello(), 0);
    let ExternalAnswer { line, .. } = process.wait(task, limit)?;
    match line.error {
        Some(error) => {
            Err(ProcessFailure::Broken(process.with_last_words(format!("it answers: {error}"), Duration::ZERO)))
        }
        None => Ok(line),
    }
}

fn who(line: AnswerHeader) -> Result<(MethodInfo, Option<Weights>), String> {
    let AnswerHeader { name, description, told, weights, eta, .. } = line;
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    if name.is_empty() || name.len() > MAX_NAME_CHARACTERS || !name.chars().all(is_plain) {
        let shown = name.escape_debug();
        return Err(format!(
            "its name is \"{shown}\"; expected 1 to {MAX_NAME_CHARACTERS} letters, digits, \"-\", \"_\" or \".\""
        ));
    }
    let eta = eta.unwrap_or(USUAL_ETA);
    check_eta(eta)?;
    if weights.len() > MAX_NAME_CHARACTERS || !weights.chars().all(|c| c.is_ascii_hexdigit()) {
        return Err(format!("its weights are \"{}\"; expected hexadecimal digits", weights.escape_debug()));
    }
    let text = |text: String, otherwise: &'static str| match text.trim() {
        "" => otherwise,
        text => &*text.chars().take(MAX_TEXT_CHARACTERS).collect::<String>().leak(),
    };
    let info = MethodInfo {
        name: name.leak(),
        description: text(description, "a program of your own"),
        prior_knowledge: text(told, "its program doesn't say"),
        eta,
    };
    let weights = (!weights.is_empty()).then(|| Weights { sha256: weights, optimiser: String::new() });
    Ok((info, weights))
}

fn check_eta(eta: f32) -> Result<(), String> {
    if (0.0..=1.0).contains(&eta) {
        return Ok(());
    }
    Err(format!("its threshold \"eta\" is {eta}; expected 0 to 1"))
}

impl ExternalMethod {
    fn state(&self, task: &Task) -> Result<MutexGuard<'_, State>, ProcessFailure> {
        loop {
            task.check()?;
            match self.process.try_lock() {
                Ok(state) => return Ok(state),
                Err(TryLockError::Poisoned(state)) => return Ok(state.into_inner()),
                Err(TryLockError::WouldBlock) => std::thread::sleep(POLL_INTERVAL),
            }
        }
    }

    /// Starts the process anew; its name must be that of this method.
    fn started(&self, task: &Task) -> Result<Process, ProcessFailure> {
        let mut process = Process::start(&self.command)
            .map_err(|error| ProcessFailure::Broken(format!("{} can't be started: {error}", self.command)))?;
        let line = greeted(&mut process, task, self.limit)?;
        if line.name != self.info.name {
            let was = self.info.name;
            return Err(ProcessFailure::Broken(format!("its name is \"{}\" now; it was \"{was}\" before", line.name)));
        }
        Ok(process)
    }

    fn asked(
        &self,
        state: &mut State,
        radar: &Radar,
        ends: &TwoEnds,
        request: &Request,
    ) -> Result<ExternalAnswer, ProcessFailure> {
        let task = &request.task;
        if state.process.as_ref().is_none_or(|process| !process.is_ours()) {
            state.process = Some(self.started(task)?);
        }
        let Some(process) = &mut state.process else { return Err(ProcessFailure::Broken("it isn't there".to_owned())) };
        // Answers to cancelled questions come first and are dropped.
        while process.pending > 0 {
            process.wait(task, self.limit)?;
        }
        state.asked += 1;
        let question = message::question(state.asked, radar, ends, request);
        process.ask(question, message::most_array_bytes(radar));
        let answer = process.wait(task, self.limit)?;
        if answer.line.id != state.asked {
            let (found, id) = (answer.line.id, state.asked);
            let why = format!("it answers question {found}; expected an answer to question {id}");
            return Err(ProcessFailure::Broken(process.with_last_words(why, Duration::ZERO)));
        }
        Ok(answer)
    }

    fn read(&self, answer: &ExternalAnswer, radar: &Radar, request: &Request) -> Result<Reconstruction, String> {
        let lambda = match answer.map(radar)? {
            Map::Lambda(lambda) => RangeAngleMap { lambda },
            Map::Decades(decades) => LogMap::new(decades).normalise(request.normalisation),
        };
        answer.line.eta.map_or(Ok(()), check_eta)?;
        Ok(Reconstruction { lambda, eta: answer.line.eta, ..Reconstruction::silence(radar) })
    }
}

impl Reconstructor for ExternalMethod {
    fn info(&self) -> MethodInfo {
        self.info
    }

    fn family(&self) -> Family {
        Family::Own
    }

    fn weights(&self, _radar: &Radar) -> Option<Weights> {
        self.weights.clone()
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let broken = |reason: String| self.unusable(format!("{reason}\n(the next request starts it anew)"));
        let failed = |failure: ProcessFailure| match failure {
            ProcessFailure::Cancelled => ReconstructError::Cancelled,
            ProcessFailure::Broken(reason) => broken(reason),
        };
        let mut state = self.state(&request.task).map_err(failed)?;
        let asked = self.asked(&mut state, radar, ends, request);
        if matches!(asked, Err(ProcessFailure::Broken(_))) {
            state.process = None;
        }
        let answer = asked.map_err(failed)?;
        if let Some(error) = &answer.line.error {
            return Err(self.unusable(error.chars().take(MAX_TEXT_CHARACTERS).collect()));
        }
        self.read(&answer, radar, request).map_err(|why| {
            let words = state.process.as_ref().map(|p| p.with_last_words(why.clone(), Duration::ZERO));
            state.process = None;
            broken(words.unwrap_or(why))
        })
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::super::message::tests::{answer_bytes, npy, small};
    use super::*;
    use ndarray::Array2;
    use num_complex::Complex64;
    use std::fs;
    use std::path::Path;
    use std::time::Instant;

    const HELLO: &str = r#"{"apertura":1,"name":"mine","description":"for tests","eta":0.25,"weights":"0f"}"#;

    /// A shell script that greets, then runs `rest`; `rest` may `cat` the answers 1.bin, 2.bin and so on.
    fn script(folder: &Path, rest: &str) -> CommandLine {
        for id in 1..=3 {
            let line = format!(r#"{{"apertura":1,"id":{id},"arrays":[{{"name":"lambda","bytes":LENGTH}}]}}"#);
            let map = Array2::from_elem((4, 8), 0.25 * id as f32);
            fs::write(folder.join(format!("{id}.bin")), answer_bytes(&line, &npy(&map))).unwrap();
        }
        let path = folder.join("script.sh");
        fs::write(&path, format!("cd {}\necho start >> starts\necho '{HELLO}'\n{rest}\n", folder.display())).unwrap();
        format!("sh {}", path.display()).parse().unwrap()
    }

    fn of(rest: &str) -> (tempfile::TempDir, ExternalMethod) {
        let folder = tempfile::tempdir().unwrap();
        let method = start(script(folder.path(), rest), Duration::from_secs(20), &Task::default()).unwrap();
        (folder, method)
    }

    fn ask(method: &ExternalMethod, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let radar = small();
        let samples = Array2::from_elem((2, 4), Complex64::new(1.0, 0.5));
        let ends = TwoEnds { first: samples.clone(), last: samples };
        method.estimate(&radar, &ends, request)
    }

    fn refused(method: &ExternalMethod) -> String {
        ask(method, &Request::default()).unwrap_err().to_string()
    }

    fn starts(folder: &Path) -> usize {
        fs::read_to_string(folder.join("starts")).unwrap().lines().count()
    }

    #[test]
    fn one_process_answers_every_request() {
        let (folder, method) = of("cat 1.bin 2.bin 3.bin; cat > /dev/null");
        assert_eq!((method.name(), method.eta(), method.description()), ("mine", 0.25, "for tests"));
        assert_eq!(method.weights(&Radar::default()).unwrap().sha256, "0f");
        for id in 1..=3 {
            assert_eq!(ask(&method, &Request::default()).unwrap().lambda.lambda[[3, 7]], 0.25 * id as f32);
        }
        assert_eq!(starts(folder.path()), 1);
    }

    #[test]
    fn a_process_that_ends_is_told_with_its_last_words() {
        let (_folder, method) = of("echo out of memory >&2; exit 3");
        let told = refused(&method);
        assert!(told.starts_with("mine: it ended (exit status: 3)") && told.contains("out of memory"), "{told}");
    }

    #[test]
    fn the_next_request_starts_it_anew() {
        let (folder, method) = of("[ -e there ] || { touch there; exit 1; }\ncat 2.bin; cat > /dev/null");
        refused(&method);
        assert_eq!(ask(&method, &Request::default()).unwrap().lambda.lambda[[0, 0]], 0.5);
        assert_eq!(starts(folder.path()), 2);
    }

    #[test]
    fn a_process_that_hangs_is_ended() {
        let folder = tempfile::tempdir().unwrap();
        // A process started by the shell would hold the pipes open.
        let command = script(folder.path(), "echo thinking >&2; sleep 600 & echo $! > pid; wait");
        let method = start(command, Duration::from_millis(400), &Task::default()).unwrap();
        let told = refused(&method);
        assert!(told.contains("no answer within 0.4 s") && told.contains("thinking"), "{told}");
        let pid = fs::read_to_string(folder.path().join("pid")).unwrap();
        let began = Instant::now();
        let is_there = || fs::read_to_string(format!("/proc/{}/comm", pid.trim())).is_ok_and(|name| name == "sleep\n");
        while cfg!(target_os = "linux") && is_there() {
            assert!(began.elapsed() < Duration::from_secs(10), "what the process started goes on");
        }
    }

    #[test]
    fn an_answer_to_another_question_is_told() {
        let (_folder, method) = of("cat 2.bin; cat > /dev/null");
        let told = refused(&method);
        assert!(told.contains("answers question 2; expected an answer to question 1"), "{told}");
    }

    #[test]
    fn what_the_process_refuses_keeps_it_alive() {
        let (folder, method) = of(r#"echo '{"apertura":1,"id":1,"error":"only 3 GHz"}'; cat 2.bin; cat > /dev/null"#);
        assert_eq!(refused(&method), "mine: only 3 GHz");
        assert!(ask(&method, &Request::default()).is_ok());
        assert_eq!(starts(folder.path()), 1);
    }

    #[test]
    fn a_cancelled_request_leaves_the_process_alive() {
        let (folder, method) = of("until [ -e go ]; do sleep 0.05; done; cat 1.bin 2.bin; cat > /dev/null");
        let request = Request::default();
        let task = request.task.clone();
        let waiting = std::thread::spawn(move || {
            std::thread::sleep(Duration::from_millis(200));
            task.cancel();
        });
        assert_eq!(ask(&method, &request), Err(ReconstructError::Cancelled));
        waiting.join().unwrap();
        fs::write(folder.path().join("go"), "").unwrap();
        assert_eq!(ask(&method, &Request::default()).unwrap().lambda.lambda[[0, 0]], 0.5, "the first is passed over");
        assert_eq!(starts(folder.path()), 1);
    }

    #[test]
    fn commands_that_are_no_methods_are_told() {
        let folder = tempfile::tempdir().unwrap();
        let hello = |text: &str| {
            let file = tempfile::NamedTempFile::new_in(folder.path()).unwrap().into_temp_path().keep().unwrap();
            fs::write(&file, text).unwrap();
            format!("sh -c 'cat {}; echo words >&2; cat > /dev/null'", file.display())
        };
        let named = |name: &str| hello(&format!("{{\"apertura\":1,\"name\":\"{name}\"}}\n"));
        for (command, part) in [
            ("/nowhere/program x".to_owned(), "/nowhere/program x: it can't be started"),
            ("sh -c 'echo no module >&2; exit 1'".to_owned(), "no module"),
            (named("two words"), "its name is \"two words\"; expected 1 to 40 letters"),
            (named(""), "its name is \"\""),
            (hello("{\"apertura\":1,\"name\":\"a\",\"eta\":3}\n"), "\"eta\" is 3; expected 0 to 1"),
            (hello("{\"apertura\":1,\"error\":\"no GPU\"}\n"), "it answers: no GPU"),
            (hello("{\"apertura\":4}\n"), "version 4"),
        ] {
            let Err(error) = start(command.parse().unwrap(), Duration::from_secs(20), &Task::default()) else {
                panic!("{command} is no method");
            };
            assert!(error.to_string().contains(part), "{error}");
        }
    }
}
