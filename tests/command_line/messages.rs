//! Messages on arguments and files that the program can't use: the value found, the values allowed, and a remedy.

use crate::cli::*;

#[test]
fn numbers_out_of_range_say_what_is_allowed() {
    let folder = folder();
    for (arguments, allowed) in [
        ("robustness --phase-degrees -5", "'--phase-degrees <DEGREES>': expected a number from 0 to 180"),
        ("robustness --phase-degrees 200", "expected a number from 0 to 180"),
        ("robustness --scale 1,x", "expected a number from 0 to 180"),
        ("robustness --set 4", "expected test set 1, 2 or 3, or clusters"),
        ("robustness --count 0", "expected a whole number from 1 to 10000"),
        ("evaluate --count 1e9", "'--count <N>': expected a whole number from 1 to 1000000"),
        ("evaluate --seed -1", "expected a whole number from 0 to 18446744073709551615"),
        ("evaluate --floor snr=9999", "snr=DB with DB between -100 and 300"),
        ("evaluate --shard 4/4", "expected I/N with I from 0 to N - 1"),
        ("scenes --set 1 --count -3 -o x", "expected a whole number from 1 to 1000000"),
        ("scenes --set 1 --index -3 -o x.toml", "expected a whole number from 0 to 4294967295"),
        ("layouts --count 1.5", "expected a whole number from 1 to 10000"),
        ("bounds --monte-carlo 0", "expected a whole number from 1 to 100000"),
        ("bounds --snr 500", "expected decibels between -200 and 200"),
        ("bounds --layout three-ends", "three-ends"),
        ("bounds --layout random=2000", "1 to 1024"),
        ("bounds --at 5,-1", "Y above 0"),
        ("bounds --apart 1e6", "expected columns from -649 to 374"),
        ("layouts --layout mimo=3x3 --count 1", "own grid"),
        ("budget --range -1", "expected metres from 0.001"),
        ("bench --reflectors 10,20000", "expected a whole number from 1 to 10000"),
        ("bench --repeats -1", "expected a whole number from 1 to 1000"),
        ("bench --methods --count 2000", "expected a whole number from 1 to 1000"),
        ("threshold --method baseline --false-alarm 0", "expected a number from 0.01 to 50"),
        ("worsen s.toml --method baseline --within -2 -o x.toml", "expected a number from 0.000001 to 1000"),
        ("worsen s.toml --method baseline --tries 0 -o x.toml", "expected a whole number from 1 to 4294967295"),
        ("worsen s.toml --method baseline --minutes -2 -o x.toml", "expected a number from 0.001 to 525600"),
        ("maps s.toml -o x.npz --seed -2", "expected a whole number from 0"),
        ("maps s.toml -o x.png --normalisation db=9999", "db=RANGE with RANGE between 1 and 400"),
    ] {
        let says = contains(allowed).and(contains("unexpected argument").not());
        apertura(&folder).args(arguments.split(' ')).assert().failure().stderr(says);
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is written");
}

#[test]
fn a_mistyped_command_is_named_with_the_one_meant() {
    let folder = folder();
    std::fs::write(folder.path().join("scene"), "").unwrap();
    for (arguments, says, is_of_clap) in [
        ("mpas s.toml", "no command \"mpas\", did you mean \"maps\"?", false),
        ("range-dopler s.toml -o d.png", "no command \"range-dopler\", did you mean \"range-doppler\"?", false),
        ("xyzzy s.toml", "no command \"xyzzy\"\n", false),
        ("s.toml maps", "'maps' cannot be used with", true),
        ("scene maps", "'maps' cannot be used with", true),
        ("maps s.toml --bogus", "unexpected argument '--bogus'", true),
        ("help mpas", "'mpas'", true),
    ] {
        let told = call(&folder, arguments).assert().code(2).stderr(contains(says));
        if is_of_clap {
            told.stderr(contains("no command").not());
        }
    }
    call(&folder, "--help").assert().code(0);
}

#[test]
fn what_is_no_archive_of_samples_is_named() {
    let folder = folder();
    let run =
        |name: &str| call(&folder, &format!("reconstruct {name} -o out.npz --method baseline")).assert().failure();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    call(&folder, "scenes --set 2 --index 0 -o s.toml").assert().success();
    call(&folder, "scenes --set 2 --index 0 -o s.npz").assert().success();
    for scene in ["s.toml", "s.npz"] {
        let advice = format!("`apertura maps {scene} -o IN.npz` computes them");
        run(scene).stderr(contains(format!("{scene} is a scene")).and(contains(advice)));
    }
    write("m.onnx", b"\x08\x08\x12\x07pytorch");
    run("m.onnx").stderr(contains("m.onnx is an ONNX model; expected an archive (.npz) with sub0 and sub1"));
    write("p.png", b"\x89PNG\r\n\x1a\n");
    run("p.png").stderr(contains("p.png is a picture (.png)"));
    write("half.npz", b"PK\x03\x04");
    run("half.npz").stderr(contains("half.npz"));
    run("missing.npz").stderr(contains("missing.npz").and(contains("No such file")));
    call(&folder, "maps s.toml -o in.npz").assert().success();
    call(&folder, "reconstruct in.npz -o out.npz --method baseline").assert().success();
}

#[test]
fn the_folder_of_one_scene_is_made() {
    let folder = folder();
    let run = |output: &str| call(&folder, &format!("scenes --set 1 --index 4 -o {output}")).assert();
    run("new/deep/s.toml").success();
    assert!(folder.path().join("new/deep/s.toml").exists());
    run("other/s.png").failure().stderr(contains("s.png").and(contains(".toml or .npz")));
    assert!(!folder.path().join("other").exists(), "no folder for a file that can't be written");
}

#[cfg(feature = "network")]
#[test]
fn what_is_no_weight_file_is_named() {
    let folder = folder();
    let evaluate = "evaluate --set 1 --count 1 --method thesis --weights";
    let run = |name: &str| call(&folder, &format!("{evaluate} {name}")).assert().failure();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    write("m.onnx", b"\x08\x08\x12\x07pytorch");
    run("m.onnx").stderr(contains("it is an ONNX model; expected weights as safetensors, or PyTorch's .pt"));
    write("s.toml", b"[[object]]\nkind = \"point\"\n");
    run("s.toml").stderr(contains("it is a scene (.toml)"));
    write("e.pt", b"\x80\x02}X\x05\x00\x00\x00epochK\x03s.");
    run("e.pt").stderr(contains("it holds no tensors; expected a state_dict"));
    let header = br#"{"a.weight":{"dtype":"F32","shape":[1],"data_offsets":[0,4]}}"#;
    write("x.safetensors", &[&(header.len() as u64).to_le_bytes(), header.as_slice(), &[0; 4]].concat());
    run("x.safetensors").stderr(contains("names no network, and none of ours has its tensors (1 in all): a.weight"));
}

#[test]
fn files_of_a_later_version_say_so() {
    let folder = folder();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("s.toml", "format = 3\nmotion = true\n\n[[object]]\nkind = \"swarm\"\n");
    write("r.toml", "format = 9\n\n[radar]\n\n[recording]\nfile = \"a.npz\"\n");
    for (file, says) in [
        ("s.toml", "line 1, column 10: format is 3, of a later version of apertura; this one reads formats 1 to 2"),
        ("r.toml", "format is 9, of a later version of apertura"),
    ] {
        apertura(&folder).args(["maps", file, "-o", "x.png"]).assert().failure().stderr(contains(says));
    }
    assert!(!folder.path().join("x.png").exists());
    write("s.toml", "format = 1\n\n[[object]]\nkind = \"point\"\nx_metres = 0.0\ny_metres = 9.0\n");
    call(&folder, "maps s.toml -o x.png").assert().success();
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_in_one_sentence() {
    let folder = folder();
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_apertura"));
    command.current_dir(folder.path()).args(["scenes", "--set", "1", "--count", "1", "-o", "scenes"]);
    let done = command.stdout(full).output().unwrap();
    let told = String::from_utf8(done.stderr).unwrap();
    assert_eq!((done.status.code(), told.lines().count()), (Some(1), 1), "{told}");
    assert!(told.contains("standard output: No space left on device"), "{told}");
}

#[cfg(target_os = "linux")]
#[test]
fn notes_that_cannot_be_written_end_no_command() {
    let rows = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/program-0.1.0/rows.csv");
    let merge = |stderr: Option<File>| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_apertura"));
        command.args(["evaluate", "--merge"]).arg(&rows);
        if let Some(file) = stderr {
            command.stderr(file);
        }
        command.output().unwrap()
    };
    let told = merge(None);
    assert!(told.status.success() && String::from_utf8_lossy(&told.stderr).contains("note: "), "{told:?}");
    let full = merge(Some(File::options().write(true).open("/dev/full").unwrap()));
    assert!(full.status.success() && full.stdout == told.stdout, "{full:?}");
}

#[test]
fn no_command_writes_over_what_it_reads() {
    let folder = folder();
    call(&folder, "scenes --set 1 --index 0 -o s.toml").assert().success();
    call(&folder, "maps s.toml -o in.npz").assert().success();
    std::fs::write(folder.path().join("rec.toml"), "[recording]\nfile = \"in.npz\"\n").unwrap();
    let samples = std::fs::read(folder.path().join("in.npz")).unwrap();
    for arguments in [
        "reconstruct in.npz -o in.npz --method baseline",
        "reconstruct rec.toml -o in.npz",
        "maps in.npz -o ./in.npz",
        "maps rec.toml -o in.npz",
        "range-doppler rec.toml -o in.npz",
    ] {
        let told = "in.npz: holds what this command reads; expected another name";
        call(&folder, arguments).assert().failure().stderr(contains(told));
        assert_eq!(std::fs::read(folder.path().join("in.npz")).unwrap(), samples, "{arguments}");
    }
}

#[cfg(unix)]
#[test]
fn pipes_are_refused_before_they_are_opened() {
    let folder = folder();
    for name in ["pipe.bin", "pipe.npz", "pipe.toml"] {
        let made = std::process::Command::new("mkfifo").arg(folder.path().join(name)).status().unwrap();
        assert!(made.success());
        let mut command = call(&folder, &format!("maps {name} -o out.png"));
        command.timeout(std::time::Duration::from_secs(60)).assert().failure().stderr(contains("pipe; expected"));
    }
}
