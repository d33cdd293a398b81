//! Files are whole or not there: after kill -9, on a full disk, in a folder that is read-only or vanishes.
//!
//! The process that is killed is this test program again, asked for one of the tests that are called `child`.

use crate::prelude::*;
use apertura::files::{write_atomically, write_bytes};
use apertura::interact::{Autosave, Document, Editor, Restored};
use apertura::scene::file;
use std::io;
use std::io::{Read, Write};
use std::process::Stdio;

const FOLDER: &str = "APERTURA_TEST_FOLDER";
const KILLS: u64 = 12;

/// A scene whose name is its number of points, so that a part of it is found out.
fn numbered(number: usize) -> SceneFile {
    let scene = Scene::of_points((0..number).map(|i| (i as f64, 5.0)));
    SceneFile { scene: Scene { name: number.to_string(), ..scene }, ..SceneFile::default() }
}

fn number_of(scene: &Scene) -> usize {
    let number = scene.name.parse().expect("a number");
    assert_eq!(scene.objects.len(), number, "the scene is not whole");
    number
}

fn child(name: &str, folder: &Path) -> Command {
    let mut command = Command::new(std::env::current_exe().expect("this program"));
    command.args(["--exact", &format!("whole_files::{name}"), "--ignored", "--nocapture"]).env(FOLDER, folder);
    command
}

fn folder_of_child() -> Option<PathBuf> {
    std::env::var_os(FOLDER).map(PathBuf::from)
}

fn safe(number: usize) {
    let mut out = io::stdout();
    let _nobody_listens = writeln!(out, "safe {number}").and_then(|()| out.flush());
}

fn kill(name: &str, folder: &Path, rng: &mut ChaCha8Rng) -> usize {
    let mut process = child(name, folder).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("a child");
    let begun = folder.join("begun");
    let deadline = Instant::now() + Duration::from_secs(60);
    while !begun.exists() {
        assert!(Instant::now() < deadline, "{name} never began");
        std::thread::sleep(Duration::from_millis(2));
    }
    std::thread::sleep(Duration::from_micros(rng.random_range(0..60_000)));
    process.kill().expect("the child can be killed");
    let mut said = String::new();
    process.stdout.take().expect("its output").read_to_string(&mut said).expect("text");
    process.wait().expect("its end");
    std::fs::remove_file(begun).expect("the sign can be taken away");
    let numbers = said.lines().filter_map(|l| l.strip_prefix("safe ")?.parse().ok());
    numbers.max().unwrap_or(0)
}

#[test]
#[ignore = "the child of the test below"]
fn child_saves() {
    let Some(folder) = folder_of_child() else { return };
    let path = folder.join("scene.toml");
    let start = file::load(&path).map_or(0, |f| number_of(&f.scene));
    std::fs::write(folder.join("begun"), "").unwrap();
    for number in start.. {
        file::save(&path, &numbered(number)).unwrap();
        safe(number);
    }
}

#[test]
fn a_kill_while_saving_leaves_the_old_file_or_the_new_one() {
    let folder = tempfile::tempdir().unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let path = folder.path().join("scene.toml");
    let mut safe = 0;
    for _ in 0..KILLS {
        // A child that is killed early saves nothing new.
        safe = kill("child_saves", folder.path(), &mut rng).max(safe);
        if path.exists() {
            let found = number_of(&file::load(&path).unwrap().scene);
            assert!(found == safe || found == safe + 1, "{found} where {safe} was saved");
            safe = found;
        }
    }
    assert!(number_of(&file::load(&path).unwrap().scene) > 0);
}

#[test]
#[ignore = "the child of the test below"]
fn child_autosaves() {
    let Some(folder) = folder_of_child() else { return };
    let mut autosave = Autosave::claim(&folder.join("data"));
    let restored = autosave.restore();
    let start = latest(&restored).unwrap_or(0);
    let mut editor = Editor::start(restored, None, Document::unsaved(None, numbered(start)));
    std::fs::write(folder.join("begun"), "").unwrap();
    for number in start + 1.. {
        if number % 20 == 0 {
            editor.open(Document::unsaved(None, numbered(number)));
        } else {
            editor.edit(None, |scene, _| *scene = numbered(number).scene);
        }
        autosave.keep_now(&editor).unwrap();
        safe(number);
    }
}

fn latest(restored: &Restored) -> Option<usize> {
    assert!(restored.problems.is_empty(), "{:?}", restored.problems);
    restored.left.iter().chain(&restored.on_screen).map(|d| number_of(d.scene())).max()
}

#[test]
fn a_kill_while_autosaving_loses_no_more_than_the_last_edit() {
    let folder = tempfile::tempdir().unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let mut safe = 0;
    for _ in 0..KILLS {
        safe = kill("child_autosaves", folder.path(), &mut rng).max(safe);
        let restored = Autosave::claim(&folder.path().join("data")).restore();
        let found = latest(&restored).unwrap_or(0);
        assert!(found == safe || found == safe + 1, "{found} where {safe} was safe");
        safe = found;
        let left: Vec<usize> = restored.left.iter().map(|d| number_of(d.scene())).collect();
        let lost = (20..safe).step_by(20).map(|n| n - 1).rev().take(60).find(|n| !left.contains(n));
        assert_eq!(lost, None, "of those left behind: {left:?}");
    }
}

#[test]
#[ignore = "the child of the test below"]
fn child_saves_too_much() {
    let Some(folder) = folder_of_child() else { return };
    match file::save(&folder.join("scene.toml"), &numbered(5000)) {
        Ok(()) => println!("saved"),
        Err(error) => println!("error: {error}"),
    }
}

/// Runs that child where no file can grow beyond 8 blocks, as on a full disk; returns its output.
#[cfg(unix)]
fn save_too_much(folder: &Path) -> String {
    let program = child("child_saves_too_much", folder);
    let words = std::iter::once(program.get_program()).chain(program.get_args());
    let line = "trap '' XFSZ; ulimit -f 8; exec \"$@\"";
    let mut shell = Command::new("sh");
    shell.args(["-c", line, "sh"]).args(words).env(FOLDER, folder);
    String::from_utf8(shell.output().expect("a shell").stdout).expect("text")
}

#[cfg(unix)]
#[test]
fn a_file_that_does_not_fit_leaves_the_old_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    file::save(&path, &numbered(3)).unwrap();
    let said = save_too_much(folder.path());
    assert!(said.contains("error: ") && said.contains("scene.toml"), "{said}");
    assert_eq!(number_of(&file::load(&path).unwrap().scene), 3);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "no half file stays");
}

#[cfg(unix)]
#[test]
fn a_read_only_folder_is_named() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    std::fs::set_permissions(folder.path(), std::fs::Permissions::from_mode(0o555)).unwrap();
    // The system's own folder refuses root, too.
    let refused: Vec<PathBuf> = [folder.path(), Path::new("/sys")]
        .into_iter()
        .filter(|f| f.is_dir() && std::fs::write(f.join("probe"), "").is_err())
        .map(Path::to_owned)
        .collect();
    if refused.is_empty() {
        return println!("skipped: this user may write everywhere");
    }
    for folder in refused {
        let message = file::save(&folder.join("scene.toml"), &numbered(3)).unwrap_err().to_string();
        let named = format!("nothing can be written into the folder \"{}\"", folder.display());
        assert!(message.contains("scene.toml") && message.contains(&named), "{message}");
    }
}

#[test]
fn a_folder_that_vanishes_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).unwrap();
    let path = inner.join("scene.toml");
    let result: io::Result<()> = write_atomically(&path, |out| {
        out.write_all(b"half")?;
        std::fs::remove_dir_all(&inner)
    });
    assert!(result.is_err() && !path.exists());
    let message = file::save(&path, &numbered(3)).unwrap_err().to_string();
    assert!(message.contains("there is no folder") && message.contains("inner"), "{message}");
    // The autosave's folder is its own: it comes back.
    let mut autosave = Autosave::claim(&inner);
    std::fs::remove_dir_all(&inner).unwrap();
    let mut editor = Editor::of(Document::default());
    editor.add(Object::Point(Point::new(1.0, 2.0)));
    autosave.keep_now(&editor).unwrap();
    assert_eq!(autosave.restore().on_screen.unwrap().scene(), editor.scene());
    write_bytes(&inner.join("a"), b"whole").unwrap();
}
