//! A monkey at the app: random pointer, keys, commands, files, kills and restarts, the same ones for the same seed. After each step
//! nothing may have panicked, memory is bounded, files are whole, and of the document nothing is lost but the last edit.
//!
//! `MONKEY_SEED=7 MONKEY_MINUTES=10 cargo test --test app monkey -- --ignored --nocapture`

mod hand;
mod witness;

use crate::session::*;
use apertura::files::memory::resident_bytes;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use witness::Witness;

/// Most memory that the process may hold beyond what it held after the start: maps and history of a full-size radar, twice.
const MAX_GROWTH_BYTES: u64 = 1 << 30;

/// Objects beyond which the monkey begins anew: it duplicates everything now and then.
const MANY_OBJECTS: usize = 300;

/// Unsaved scenes beyond which it gives the oldest up, long before the window would.
const MANY_UNSAVED: usize = 32;

/// Names of the monkey's own files, each of a small radar.
const FILES: [&str; 4] = ["a.toml", "b.toml", "scene.toml", "points.npz"];

struct Monkey {
    s: Session,
    rng: ChaCha8Rng,
    witness: Witness,
    steps: u64,
    kills: u64,
}

impl Monkey {
    fn start(seed: u64) -> Monkey {
        let mut s = Session::with_methods(with_capon());
        let folder = s.folder.path().to_owned();
        let head = "[radar]\nelements = 64\nsamples = 32\nbandwidth_hz = 2.5e8\n\n";
        let point = "[[object]]\nkind = \"point\"\nx_metres = 2.0\ny_metres = 9.0\n";
        std::fs::write(folder.join("a.toml"), format!("name = \"A\"\n{head}{point}")).unwrap();
        std::fs::write(folder.join("b.toml"), format!("noise_seed = 5\n{head}{point}{point}")).unwrap();
        std::fs::write(folder.join("bad.toml"), "x = [").unwrap();
        let points = apertura::scene::file::load(&folder.join("a.toml")).unwrap();
        apertura::scene::file::save(&folder.join("points.npz"), &points).unwrap();
        s.settle();
        Monkey { s, rng: ChaCha8Rng::seed_from_u64(seed), witness: Witness::default(), steps: 0, kills: 0 }
    }

    fn step(&mut self) {
        self.act();
        self.stay_at_home();
        self.steps += 1;
        self.witness.look(self.s.state());
    }

    /// Answers dialogs that would lead out of the monkey's folder, start programs, or grow without bound.
    fn stay_at_home(&mut self) {
        let app = &mut self.s.app;
        if app.query_by_label_contains("can't hold all of this scene").is_some() {
            let answer = ["Save anyway", "Save as TOML", "Cancel"][self.rng.random_range(0..3)];
            app.get_by_label(answer).click();
            app.step();
        }
        for _ in 0..3 {
            let Some(cancel) = app.query_all_by_label("Cancel").next() else { break };
            cancel.click();
            app.step();
        }
        let (editor, arrangement) = (&app.state().editor, &app.state().arrangement);
        let crowded = editor.scene().objects.len() > MANY_OBJECTS;
        let discarded = editor.left().first().filter(|_| editor.left().len() > MANY_UNSAVED).map(|d| d.id());
        let may_train = arrangement.is_open(Panel::Training);
        let commands = [
            crowded.then_some(Command::Document(DocumentCommand::New)),
            discarded.map(|v| Command::Document(DocumentCommand::Discard(v))),
            may_train.then_some(Command::Window(WindowCommand::ClosePanel(Panel::Training))),
        ];
        for command in commands.into_iter().flatten() {
            app.state_mut().ask(command);
            app.step();
        }
    }

    fn inspect(&mut self, memory_at_first: u64) {
        let held = resident_bytes().unwrap_or(0);
        assert!(held < memory_at_first + MAX_GROWTH_BYTES, "{held} bytes are held after {} steps", self.steps);
        for said in ["failed (", "failed:"] {
            let told = self.s.app.query_all_by_label_contains(said).next().map(|n| format!("{:?}", n));
            assert!(told.is_none(), "step {}: {told:?}", self.steps);
        }
        witness::files_are_whole(self.s.folder.path(), self.s.state());
    }

    fn kill(&mut self) {
        self.kills += 1;
        if self.rng.random_bool(0.5) {
            // A hand that rests for a moment loses nothing at all.
            let deadline = Instant::now() + Duration::from_secs(60);
            while !self.s.state().is_kept() {
                assert!(Instant::now() < deadline, "step {}: the autosave has stopped", self.steps);
                self.s.app.step();
                self.witness.look(self.s.state());
                std::thread::sleep(Duration::from_millis(10));
            }
        }
        let after = tempdir().unwrap();
        copy_at_one_moment(self.s.folder.path(), after.path());
        let asked = self.rng.random_bool(0.3).then_some("b.toml");
        let app = harness(after.path(), asked, with_capon(), USUAL_SIZE);
        self.s = Session { app, folder: after };
        self.s.app.step();
        if let Err(lost) = self.witness.compare(self.s.state()) {
            panic!("step {}: {lost}", self.steps);
        }
        self.witness = Witness::default();
    }
}

fn listing(folder: &Path) -> Vec<(PathBuf, u64, Option<std::time::SystemTime>)> {
    let mut list = Vec::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let Ok(about) = entry.metadata() else { continue };
        match about.is_dir() {
            true => list.extend(listing(&entry.path())),
            false => list.push((entry.path(), about.len(), about.modified().ok())),
        }
    }
    list.sort();
    list
}

fn copy_at_one_moment(from: &Path, to: &Path) {
    loop {
        let before = listing(from);
        for (path, ..) in &before {
            let target = to.join(path.strip_prefix(from).unwrap());
            std::fs::create_dir_all(target.parent().unwrap()).unwrap();
            // The file may be gone by now; then the listing has changed.
            let _gone = std::fs::copy(path, target);
        }
        if listing(from) == before {
            return;
        }
        std::fs::remove_dir_all(to).unwrap();
    }
}

fn run(seed: u64, time: Duration) {
    let mut monkey = Monkey::start(seed);
    let (begun, memory) = (Instant::now(), resident_bytes().unwrap_or(0));
    let mut most = memory;
    while begun.elapsed() < time {
        monkey.step();
        if monkey.steps.is_multiple_of(20) {
            monkey.inspect(memory);
            most = most.max(resident_bytes().unwrap_or(0));
        }
        if monkey.rng.random_bool(0.02) {
            monkey.kill();
        }
    }
    let (steps, kills) = (monkey.steps, monkey.kills);
    println!("seed {seed}: {steps} steps, {kills} kills, {} MiB more at most", (most - memory) >> 20);
    assert!(steps > 5, "{steps} steps in {time:?}");
}

#[test]
fn thirty_seconds_of_a_monkey_lose_nothing() {
    run(1, Duration::from_secs(30));
}

#[test]
#[ignore = "long: as many minutes as MONKEY_MINUTES says"]
fn minutes_of_a_monkey_lose_nothing() {
    let number = |name: &str, usual: u64| std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(usual);
    run(number("MONKEY_SEED", 2), Duration::from_secs(60 * number("MONKEY_MINUTES", 10)));
}
