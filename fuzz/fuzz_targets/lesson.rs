//! Lessons: those that are accepted put a scene before a radar in every step.
#![no_main]

use apertura::lesson::Lesson;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok(lesson) = Lesson::from_toml(text) {
        for step in &lesson.steps {
            let _scene = step.scene();
        }
    }
});
