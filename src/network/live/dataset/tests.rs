use super::*;
use crate::signal::Floor;
use ndarray::{Array1, Array3, Array4};
use ndarray_npy::read_npy;
use num_complex::Complex64;

fn request() -> DatasetRequest {
    DatasetRequest {
        kinds: vec!["2".parse().unwrap(), "clusters".parse().unwrap()],
        counts: [2, 1, 1],
        seed: 5,
        floors: Floors::Fixed(Floor::Thesis),
        precision: DatasetPrecision::Single,
        arrays: Arrays::IDEAL,
        radars: Radars::default(),
        layout: None,
        parts: ExamplePart::usual(&Radars::default(), None),
        shard: 3,
    }
}

#[test]
fn an_example_on_disk_is_the_example() {
    let folder = tempfile::tempdir().unwrap();
    let manifest = write(folder.path(), &request(), &Task::default()).unwrap();
    let shards: Vec<u32> = manifest.splits["train"].iter().map(|shard| shard.examples).collect();
    assert_eq!(shards, [3, 1]);
    let (mixture, targets) = ("clusters".parse().unwrap(), Target::USUAL.to_vec());
    let maker = Examples::new(ExamplesRequest { mixture, seed: 5, targets, ..ExamplesRequest::default() }).unwrap();
    let example = maker.example(0, &Task::default()).unwrap();
    let path = |array: &str| folder.path().join(format!("train/00000.{array}.npy"));
    for target in Target::USUAL {
        let maps: Array3<f32> = read_npy(path(target.array())).unwrap();
        assert_eq!(maps.index_axis(ndarray::Axis(0), 1), example.target(target).unwrap());
    }
    let fine: Array4<f32> = read_npy(path("fine")).unwrap();
    let expected = &example.input.as_ref().unwrap().fine;
    assert_eq!(fine.index_axis(ndarray::Axis(0), 1).iter().copied().collect::<Vec<_>>(), *expected);
    let gain: Array1<f64> = read_npy(path("gain")).unwrap();
    assert_eq!(gain[1], example.gain);
    let ends: Array4<Complex64> = read_npy(path("ends")).unwrap();
    let last = example.ends().unwrap().last[[11, 500]] * 10f64.powf(-example.gain);
    assert_eq!(ends[[1, 1, 11, 500]], last);
    assert_eq!(manifest.splits["train"][0].kinds, ["2", "clusters", "2"]);
}

#[test]
fn the_manifest_lists_every_file() {
    let folder = tempfile::tempdir().unwrap();
    let request = DatasetRequest { parts: vec![ExamplePart::Ends], precision: DatasetPrecision::Half, ..request() };
    let manifest = write(folder.path(), &request, &Task::default()).unwrap();
    let text = std::fs::read_to_string(folder.path().join(FILE_NAME)).unwrap();
    let read: Manifest = serde_json::from_str(&text).unwrap();
    assert_eq!(read.splits, manifest.splits);
    let mut files = 0;
    for file in read.splits.values().flatten().flat_map(|shard| shard.files.values()) {
        let path = folder.path().join(&file.name);
        assert_eq!(sha256::of_file(&path).unwrap(), file.sha256, "{}", file.name);
        assert_eq!(std::fs::metadata(path).unwrap().len(), file.bytes);
        files += 1;
    }
    assert_eq!(files, 4 * 2, "ends and gain of two shards for training, one each for validation and test");
}

#[test]
fn impossible_requests_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let told = |request: DatasetRequest| write(folder.path(), &request, &Task::default()).unwrap_err().to_string();
    assert!(told(DatasetRequest { kinds: Vec::new(), ..request() }).contains("nothing to write"));
    assert!(told(DatasetRequest { counts: [0, 1, 1], ..request() }).contains("some for training"));
    assert!(told(DatasetRequest { shard: 0, ..request() }).contains("1 to 4096"));
    let twice = vec!["2".parse().unwrap(), "2".parse().unwrap()];
    assert!(told(DatasetRequest { kinds: twice, ..request() }).contains("2 is given twice"));
    std::fs::write(folder.path().join("old"), "").unwrap();
    assert!(told(request()).contains("is not empty"));
    let file = write(&folder.path().join("old"), &request(), &Task::default()).unwrap_err().to_string();
    assert!(file.ends_with("old: is a file; expected a folder"), "{file}");
}

#[test]
fn a_cancelled_dataset_has_no_manifest() {
    let folder = tempfile::tempdir().unwrap();
    let task = Task::default();
    task.cancel();
    assert!(write(folder.path(), &request(), &task).is_err() && !folder.path().join(FILE_NAME).exists());
}

#[test]
fn a_dataset_of_another_radar_and_layout_has_its_shape() {
    let folder = tempfile::tempdir().unwrap();
    let radars = Radars::Fixed(Box::new(Radar { elements: 86, end_elements: 8, samples: 128, ..Radar::default() }));
    let layout = vec![0, 1, 4, 9, 85];
    let parts = ExamplePart::usual(&radars, Some(&layout));
    assert!(!parts.contains(&ExamplePart::Features));
    assert!(ExamplePart::usual(&Radars::Random, None).contains(&ExamplePart::Features));
    let request = DatasetRequest { counts: [1, 0, 0], layout: Some(layout.clone()), radars, parts, ..request() };
    let manifest = write(folder.path(), &request, &Task::default()).unwrap();
    assert_eq!((manifest.layout, manifest.radar.unwrap().elements), (Some(layout), 86));
    let heard: Array3<Complex64> = read_npy(folder.path().join("train/00000.heard.npy")).unwrap();
    let ideal: Array3<f32> = read_npy(folder.path().join("train/00000.target_ideal.npy")).unwrap();
    assert_eq!((heard.dim(), ideal.dim()), ((2, 5, 128), (2, 128, 86)));
    let features = DatasetRequest { parts: vec![ExamplePart::Features], ..request };
    let other = tempfile::tempdir().unwrap();
    let told = write(&other.path().join("new"), &features, &Task::default()).unwrap_err().to_string();
    assert!(told.contains("hears two ends") && !other.path().join("new").exists(), "{told}");
}
