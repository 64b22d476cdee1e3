//! Inputs that are as long as they may be: each is read in a time that grows with its length, not with the square.

use islands::formats::{network_csv, urdf};
use std::fmt::Write;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// Whoever takes longer goes with the square of the length: that takes minutes, the length itself a second.
const PATIENCE: Duration = Duration::from_secs(30);

/// Reads an input in a thread of its own, and gives up on it in the end.
fn in_time<T: Send + 'static>(what: &str, read: impl FnOnce() -> T + Send + 'static) -> T {
    let (sender, receiver) = channel();
    let reader = thread::spawn(move || sender.send(read()));
    match receiver.recv_timeout(PATIENCE) {
        Ok(done) => done,
        Err(RecvTimeoutError::Timeout) => panic!("{what} takes too long"),
        Err(RecvTimeoutError::Disconnected) => {
            reader.join().expect("it does not panic").expect("it sends what it made");
            unreachable!("{what} has sent nothing")
        }
    }
}

/// As many pieces as a URDF may hold, between a beginning and an end.
fn urdf_of(begin: &str, piece: impl Fn(usize) -> String, end: &str) -> String {
    let mut text = begin.to_owned();
    let mut index = 0;
    while text.len() < urdf::BYTES_MAX - 200 {
        text += &piece(index);
        index += 1;
    }
    text + end
}

#[test]
fn the_longest_urdf_of_any_shape_is_read_or_refused_in_time() {
    let robot = "<robot name='r'>";
    let link = |i: usize| format!("<link name='l{i}'/>\n");
    let shapes = [
        ("links", urdf_of(robot, link, "</robot>")),
        ("links of one name", urdf_of(robot, |_| link(0), "</robot>")),
        (
            "joints",
            urdf_of(
                robot,
                |i| format!("<joint name='j{i}' type='fixed'><parent link='l{i}'/></joint>\n"),
                "</robot>",
            ),
        ),
        ("attributes", urdf_of("<robot ", |i| format!("a{i}='1' "), "/>")),
        ("attributes after a bracket", urdf_of("<robot a='>' ", |i| format!("a{i}='1' "), "/>")),
        ("namespaces", urdf_of("<robot ", |i| format!("xmlns:a{i}='u' "), "/>")),
        (
            "elements of many attributes",
            urdf_of(
                robot,
                |_| {
                    let attributes = (0..250).map(|i| format!("a{i}='' ")).collect::<String>();
                    format!("<link name='l' {attributes}/>\n")
                },
                "</robot>",
            ),
        ),
        ("elements within elements", urdf_of(robot, |_| "<a>".to_owned(), "")),
        ("lines", urdf_of(robot, |_| "\n<x/>".to_owned(), "</robot>")),
    ];
    for (shape, text) in shapes {
        let read = in_time(shape, move || urdf::read(&text).map(drop));
        assert!(read.is_err(), "{shape} make no body");
    }
}

#[test]
fn a_comment_may_quote_as_much_as_it_likes() {
    let quotes = "\"it's\" ".repeat(1_000);
    let body = "<link name='l'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>\
                <collision><geometry><box size='1 1 1'/></geometry></collision></link>";
    urdf::read(&format!("<robot name='r'><!-- {quotes} -->{body}</robot>")).expect("it is a body");
}

#[test]
fn a_large_network_is_drawn_in_time() {
    let mut text = String::from("part,from,to,weight,enabled,function\n");
    for index in 0..36_000 {
        writeln!(text, "link,a{index},b{index},1,true,").expect("memory takes everything");
    }
    let rows = network_csv::read_rows(text.as_bytes()).expect("it is a table");
    let drawing = in_time("a drawing", move || network_csv::dot(&rows));
    assert_eq!(drawing.matches(" -> ").count(), 36_000);
    assert_eq!(drawing.matches("[shape=box]").count(), 72_000);
}
