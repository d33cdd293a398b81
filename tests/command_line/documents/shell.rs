//! Commands of `apertura` in lines for a shell.

/// The words of a line up to its comment, quotation marks taken off.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    for letter in line.chars() {
        match (quote, letter) {
            (Some(open), _) if letter == open => quote = None,
            (None, '\'' | '"') => {
                quote = Some(letter);
                word.get_or_insert_default();
            }
            (None, '#') if word.is_none() => break,
            (None, _) if letter.is_whitespace() => words.extend(word.take()),
            _ => word.get_or_insert_default().push(letter),
        }
    }
    words.extend(word);
    words
}

/// Every command of the program in a line, with its arguments: alone, after another command, or quoted as an argument of one.
pub fn commands(line: &str) -> Vec<Vec<String>> {
    let words = words(line);
    let segments = words.split(|word| ["&&", "|", ";"].contains(&word.as_str()));
    segments
        .flat_map(|segment| match segment.iter().position(|word| word == "apertura") {
            Some(at) => vec![segment[at + 1..].to_vec()],
            None => {
                segment.iter().filter(|word| word.starts_with("apertura ")).flat_map(|word| commands(word)).collect()
            }
        })
        .collect()
}

/// The arguments with a number for each that a shell fills in (a variable, `{}` of parallel, `I/N`), and with the backend that every build has.
pub fn filled(arguments: &[String]) -> Vec<String> {
    let is_backend = |at: usize| at > 0 && arguments[at - 1] == "--backend";
    arguments
        .iter()
        .enumerate()
        .map(|(at, argument)| {
            if is_backend(at) {
                return "flex".to_owned();
            }
            let mut pieces = argument.split('$');
            let first = pieces.next().unwrap_or_default().to_owned();
            let text = pieces.fold(first, |text, piece| {
                text + "0" + piece.trim_start_matches(|c: char| c.is_ascii_uppercase() || c == '_')
            });
            text.replace("{}", "0").replace("I/N", "0/4")
        })
        .collect()
}

/// The arguments made quick: one scene in place of many, of one set, one draw, and the smallest measurement of `bench`.
pub fn shortened(arguments: &[String]) -> Vec<String> {
    let mut quick = arguments.to_vec();
    for at in 1..quick.len() {
        if ["--count", "--monte-carlo", "--check"].contains(&quick[at - 1].as_str()) {
            quick[at] = "1".to_owned();
        }
    }
    match quick.first().map(String::as_str) {
        Some("bench") => {
            quick.extend(["--algorithms", "plan", "--reflectors", "10", "--repeats", "1"].map(str::to_owned))
        }
        Some("evaluate") if !quick.iter().any(|a| a == "--set") => quick.extend(["--set", "2"].map(str::to_owned)),
        _ => {}
    }
    quick
}

#[test]
fn a_line_is_taken_apart_as_a_shell_does() {
    let found = |line| commands(line).into_iter().map(|c| c.join(" ")).collect::<Vec<_>>();
    assert_eq!(found("scripts/setup && apertura maps a.toml -o b.png   # a picture"), ["maps a.toml -o b.png"]);
    assert_eq!(found("run --wrap 'apertura evaluate --shard $I_N/3'"), ["evaluate --shard $I_N/3"]);
    assert_eq!(found("sudo apt install ./apertura.deb"), [""; 0]);
    assert_eq!(commands("apertura --method-command \"python a.py\""), [["--method-command", "python a.py"]]);
    assert_eq!(filled(&["$A_B/3".to_owned(), "{}.csv".to_owned()]), ["0/3", "0.csv"]);
}
