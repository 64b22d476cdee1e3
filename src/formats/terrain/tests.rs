//! Terrains come back from files as they went in, and what is none is refused with a sentence.

use super::*;
use crate::simulation::terrain::{POINTS_MAX, TerrainError, mountain};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const PLAIN: Sizing = Sizing { width_m: None, height_m: None, start_m: None };

fn png(size: [u32; 2], color: png::ColorType, depth: png::BitDepth, pixels: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, size[0], size[1]);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(pixels).unwrap();
    writer.finish().unwrap();
    file
}

fn obj(terrain: &Terrain) -> String {
    let [columns, rows] = terrain.points();
    let mut text = "# a hill\nmtllib hill.mtl\no hill\n".to_owned();
    for (column, row) in (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))) {
        let place_m = terrain.place_m(column, row);
        text += &format!("v {} {} {}\n", place_m.x + 3.0, place_m.y - 4.0, place_m.z);
    }
    for (column, row) in
        (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| (column, row)))
    {
        let first = row * columns + column + 1;
        text += &format!("f {first}//1 {}//1 {}//1\n", first + 1, first + columns + 1);
        text += &format!("f {first} {} {}\n", first + columns + 1, first + columns);
    }
    text
}

#[test]
fn a_grid_comes_back_to_the_last_bit() {
    let mut file = Vec::new();
    write(&mountain(), &mut file).unwrap();
    assert_eq!(read(&file, &PLAIN).unwrap(), *mountain());
    let elsewhere = Sizing { start_m: Some([1.0, 2.0]), ..PLAIN };
    assert_eq!(read(&file, &elsewhere).unwrap().start_m(), [1.0, 2.0]);
    let sized = Sizing { width_m: Some(3.0), ..PLAIN };
    assert!(matches!(read(&file, &sized), Err(TerrainFileError::Sized)));
}

#[test]
fn a_mesh_of_the_mountain_is_the_mountain() {
    let read = read(obj(&mountain()).as_bytes(), &PLAIN).unwrap();
    assert_eq!((read.points(), read.step_m()), ([81, 81], 0.25));
    assert_eq!((read.half_m(), read.start_m()), (mountain().half_m(), mountain().start_m()));
    for i in 0..500 {
        let (x_m, y_m) = (9.9 * libm::sin(f64::from(i)), 9.9 * libm::cos(1.3 * f64::from(i)));
        let [expected, found] = [&*mountain(), &read].map(|it| it.height_m(x_m, y_m));
        assert!((expected - found).abs() < 1e-5, "{found}, not {expected} at {x_m}, {y_m}");
    }
    let sizing = Sizing { width_m: Some(10.0), height_m: Some(1.0), start_m: None };
    let small = super::read(obj(&mountain()).as_bytes(), &sizing).unwrap();
    let heights_m = || small.heights_m().iter().copied();
    let range_m = heights_m().fold(0.0, f64::max) - heights_m().fold(9.0, f64::min);
    assert!((small.half_m().x - 5.0).abs() < 1e-9 && (range_m - 1.0).abs() < 1e-6, "{range_m}");
}

#[test]
fn of_an_overhang_the_upper_surface_counts_and_where_there_is_none_the_lowest_height() {
    let text = "v 0 0 1\nv 4 0 1\nv 4 4 1\nv 0 4 1\nv 0 0 2\nv 2 0 2\nv 2 4 2\nv 0 4 2\n\
        v 8 0 0.5\nv 6 4 1\nv 8 4 1\nf 5 6 7 8\nf 4 3 2 1\nf -3 -2 -1\n";
    let terrain = read(text.as_bytes(), &PLAIN).unwrap();
    assert_eq!(terrain.half_m(), nalgebra::Vector2::new(4.0, 2.0));
    assert_eq!(terrain.height_m(-3.5, 0.0), 2.0);
    assert_eq!(terrain.height_m(-1.5, 0.0), 1.0);
    assert_eq!(terrain.height_m(1.0, 1.5), 0.5);
}

#[test]
fn an_image_is_seen_from_above_with_white_high_and_north_at_the_top() {
    let shades: [u8; 6] = [0, 51, 255, 0, 102, 0];
    let eight = png([3, 2], png::ColorType::Grayscale, png::BitDepth::Eight, &shades);
    let wide: Vec<u8> = shades.iter().flat_map(|&shade| [shade; 2]).collect();
    let sixteen = png([3, 2], png::ColorType::Grayscale, png::BitDepth::Sixteen, &wide);
    for file in [eight, sixteen] {
        let terrain = read(&file, &PLAIN).unwrap();
        assert_eq!((terrain.points(), terrain.step_m()), ([3, 2], 10.0));
        assert_eq!(terrain.heights_m(), [0.0, 2.0, 0.0, 0.0, 1.0, 5.0]);
        let sizing = Sizing { width_m: Some(4.0), height_m: Some(2.5), start_m: Some([1.0, 0.5]) };
        let terrain = read(&file, &sizing).unwrap();
        assert_eq!((terrain.step_m(), terrain.start_m()), (2.0, [1.0, 0.5]));
        assert_eq!(terrain.height_m(2.0, 1.0), 2.5);
    }
}

#[test]
fn what_is_no_terrain_is_refused_with_a_sentence() {
    let gray =
        |size, pixels: &[u8]| png(size, png::ColorType::Grayscale, png::BitDepth::Eight, pixels);
    let many = POINTS_MAX as u32 + 1;
    let mut huge = gray([2, 2], &[0; 4]);
    // The width in its header, with the checksum that belongs to it left wrong.
    huge[16..20].copy_from_slice(&u32::MAX.to_be_bytes());
    let cliff = png([2, 2], png::ColorType::Grayscale, png::BitDepth::Eight, &[0, 255, 0, 255]);
    let steep = Sizing { width_m: Some(0.1), ..PLAIN };
    let files: Vec<(Vec<u8>, Sizing, &str)> = vec![
        (huge, PLAIN, "it is no sound PNG image"),
        (gray([many, 2], &vec![0; many as usize * 2]), PLAIN, "it has 1026 × 2 pixels"),
        (gray([1, 2], &[0; 2]), PLAIN, "it has 1 × 2 pixels"),
        (gray([2, 2], &[0; 4])[..50].to_vec(), PLAIN, "it is no sound PNG image"),
        (png([2, 2], png::ColorType::Rgb, png::BitDepth::Eight, &[0; 12]), PLAIN, "it has colours"),
        (cliff, steep, "it rises by 5 m from one point to the next, 0.1 m on"),
        (gray([2, 2], &[0; 4]), Sizing { width_m: Some(-1.0), ..PLAIN }, "a size of -1 m"),
        (gray([2, 2], &[0; 4]), Sizing { height_m: Some(f64::NAN), ..PLAIN }, "a size of NaN m"),
        (
            gray([2, 2], &[255; 4]),
            Sizing { height_m: Some(1e9), ..PLAIN },
            "a height is 1000000000",
        ),
        (gray([2, 2], &[0; 4]), Sizing { start_m: Some([11.0, 0.0]), ..PLAIN }, "a body cannot"),
        (vec![0xff, 0xfe], PLAIN, "it is neither"),
        (vec![], PLAIN, "it has no faces"),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_vec(), PLAIN, "it has no faces"),
        (b"v 0 0 0\nv 1 0 0\nv 1 0 1\nf 1 2 3\n".to_vec(), PLAIN, "it has no faces"),
        (b"v 0 0\n".to_vec(), PLAIN, "line 1: a vertex has three numbers"),
        (b"v 0 0 NaN\n".to_vec(), PLAIN, "line 1: \"NaN\" is no place"),
        (b"v 0 inf 0\n".to_vec(), PLAIN, "line 1: \"inf\" is no place"),
        (b"v 0 0 x\n".to_vec(), PLAIN, "line 1: \"x\" is no number"),
        (b"v 0 0 0\nf 1 1\n".to_vec(), PLAIN, "line 2: a face has 2 corners"),
        (b"v 0 0 0\nf 1 2 1\n".to_vec(), PLAIN, "line 2: there is no vertex 2"),
        (b"v 0 0 0\nf 0 1 1\n".to_vec(), PLAIN, "line 2: there is no vertex 0"),
        (b"v 0 0 0\nf -9223372036854775808 1 1\n".to_vec(), PLAIN, "line 2: there is no vertex"),
        (b"islands-terrain-1,2,2,1,0,0\n0,0\n0,0,0\n".to_vec(), PLAIN, "line 3: it is not"),
        (b"islands-terrain-1,2,2,1,0,0\n0,0\n".to_vec(), PLAIN, "line 3: it is not"),
        (b"islands-terrain-1,2,2,1,0,0\n0,0\n0,NaN\n".to_vec(), PLAIN, "a height is NaN m"),
        (b"islands-terrain-1,2,99999999,1,0,0\n".to_vec(), PLAIN, "line 1: it is not"),
    ];
    for (file, sizing, begins) in files {
        let error = read(&file, &sizing).map(|_| begins).unwrap_err().to_string();
        assert!(error.starts_with(begins), "{error}, not {begins}");
    }
}

#[test]
fn the_height_that_is_wished_for_is_that_of_the_surface_whatever_is_below_it() {
    let text = "v 0 0 20\nv 4 0 20\nv 4 4 21\nv 0 4 21\nv 0 0 -30\nv 4 0 -30\nv 4 4 -30\nv 0 4 -30\n\
        f 1 2 3 4\nf 8 7 6 5\n";
    let sizing = Sizing { height_m: Some(3.0), ..PLAIN };
    let terrain = super::read(text.as_bytes(), &sizing).unwrap();
    assert_eq!(terrain.height_m(0.0, -2.0), 20.0);
    assert!((terrain.height_m(0.0, 2.0) - 23.0).abs() < 1e-5, "{}", terrain.height_m(0.0, 2.0));
}

#[test]
fn lines_of_any_length_are_refused_at_their_first_words_and_hardly_quoted() {
    let face = format!("v 0 0 0\nf{}\n", " 1".repeat(500_000));
    let row = format!("islands-terrain-1,2,2,1,0,0\n0{}\n0,0\n", ",0".repeat(500_000));
    let long = "é".repeat(500_000);
    let files = [
        (face, "line 2: a face has more than 1000 corners: split it"),
        (row, "line 2: it is not as a run writes it"),
        (format!("v 0 0 {long}\n"), "line 1: \""),
        (format!("v 0 0 1{}\n", "0".repeat(300)), "line 1: \"10000"),
        (format!("v 0 0 0\nf 1 1 {long}\n"), "line 2: \""),
    ];
    for (file, begins) in files {
        let error = read(file.as_bytes(), &PLAIN).map(|_| begins).unwrap_err().to_string();
        assert!(error.starts_with(begins), "{error}, not {begins}");
        assert!(error.chars().count() < 120, "{error}");
    }
}

#[test]
fn triangles_in_too_many_layers_are_refused_in_bounded_time() {
    let mut text = "v 0 0 0\nv 1 0 0\nv 1 1 0\n".to_owned();
    text += &"f 1 2 3\n".repeat(100_000);
    assert!(matches!(read(text.as_bytes(), &PLAIN), Err(TerrainFileError::Layers)));
}

#[test]
fn files_of_any_content_are_terrains_or_refused() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut grid = Vec::new();
    write(&read(b"v 0 0 0\nv 40 0 0\nv 40 40 1\nf 1 2 3\n", &PLAIN).unwrap(), &mut grid).unwrap();
    let image = png([9, 9], png::ColorType::Grayscale, png::BitDepth::Eight, &[7; 81]);
    let mesh = b"v 0 0 0\nv 4 0 1\nv 4 4 2\nv 0 4 1\nf 1 2 3 4\nf -1/2 -2 -3\n".to_vec();
    let mut read_well = 0;
    for _ in 0..3_000 {
        let mut file = [&image, &mesh, &grid][rng.random_range(0..3)].clone();
        for _ in 0..rng.random_range(1..4) {
            let at = rng.random_range(0..file.len());
            file[at] = if rng.random() { rng.random() } else { b"0123456789.-e ,/\n"[at % 16] };
        }
        read_well += usize::from(read(&file, &PLAIN).is_ok());
    }
    assert!(read_well > 150, "{read_well}");
}

#[test]
fn a_wish_that_cannot_be_is_named() {
    let error = TerrainFileError::from(TerrainError::Step(0.001));
    assert_eq!(
        error.to_string(),
        "its points would be 0.001 m apart; that must be from 0.01 to 100 m"
    );
}
