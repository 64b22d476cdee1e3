//! The elements of a URDF, read one by one.

use super::error::{UrdfError, shortened};
use super::{EXTENSION, LINKS_MAX};
use crate::creature::{JointKind, Shape, Wave};
use nalgebra::{
    Isometry3, Matrix3, Quaternion, Translation3, UnitQuaternion, UnitVector3, Vector3, vector,
};
use roxmltree::{Document, Node};

/// What a file says, as it says it.
#[derive(Debug, Default)]
pub struct Robot {
    pub name: String,
    pub links: Vec<LinkElement>,
    pub joints: Vec<JointElement>,
    pub extension: Option<Extension>,
}

/// A link; all is in its own frame.
#[derive(Debug)]
pub struct LinkElement {
    pub name: String,
    pub line: u32,
    pub inertial: Option<Inertial>,
    pub solids: Vec<(Isometry3<f64>, Shape)>,
    /// Whether its solids are what is seen of it, since nothing is said of what touches.
    pub only_visual: bool,
}

#[derive(Debug)]
pub struct Inertial {
    pub mass_kg: f64,
    pub origin: Isometry3<f64>,
    pub moments_kg_m2: Matrix3<f64>,
}

#[derive(Debug)]
pub struct JointElement {
    pub name: String,
    pub line: u32,
    pub kind: JointKind,
    pub parent: String,
    pub child: String,
    pub origin: Isometry3<f64>,
    pub effort_nm: f64,
    pub is_limited: bool,
    pub is_damped: bool,
}

/// What only our own files say.
#[derive(Debug)]
pub struct Extension {
    pub period_s: f64,
    pub root_rotation: Option<UnitQuaternion<f64>>,
    pub motors: Vec<MotorElement>,
    pub poses: Vec<ExactPose>,
}

#[derive(Debug)]
pub struct MotorElement {
    pub joint: String,
    pub line: u32,
    pub wave: Wave,
}

#[derive(Debug)]
pub struct ExactPose {
    pub joint: String,
    pub parent_from_joint: Isometry3<f64>,
    pub joint_from_link: Isometry3<f64>,
}

/// Reads every element that counts.
///
/// # Errors
/// The first thing that is wrong.
pub fn robot(document: &Document) -> Result<Robot, UrdfError> {
    let (root, lines) = (document.root_element(), Lines::of(document));
    if root.tag_name().name() != "robot" {
        return Err(UrdfError::Root(shortened(root.tag_name().name())));
    }
    let mut robot =
        Robot { name: root.attribute("name").unwrap_or_default().to_owned(), ..Robot::default() };
    for node in root.children().filter(Node::is_element) {
        match node.tag_name().name() {
            _ if node.tag_name().namespace().is_some_and(|uri| uri.contains("xacro")) => {
                return Err(unsupported(&node, "xacro", "expand the file with xacro first"));
            }
            "link" => robot.links.push(link(&node, &lines)?),
            "joint" => robot.joints.push(joint(&node, &lines)?),
            EXTENSION => robot.extension = Some(extension(&node, &lines)?),
            _ => {}
        }
        if robot.links.len().max(robot.joints.len()) > LINKS_MAX {
            return Err(UrdfError::TooLarge);
        }
    }
    Ok(robot)
}

fn link(node: &Node, lines: &Lines) -> Result<LinkElement, UrdfError> {
    let of = |kind: &'static str| -> Result<Vec<_>, UrdfError> {
        let solids = node.children().filter(|child| child.has_tag_name(kind));
        solids.map(|solid| Ok((origin(&solid)?, shape(&solid)?))).collect()
    };
    let touching = of("collision")?;
    let only_visual = touching.is_empty();
    Ok(LinkElement {
        name: attribute(node, "name")?.to_owned(),
        line: lines.begun_at(node),
        inertial: child(node, "inertial").map(|inertial| self::inertial(&inertial)).transpose()?,
        // What is only to be seen may be a mesh, as long as there is something else to touch with.
        solids: if only_visual { of("visual")? } else { touching },
        only_visual,
    })
}

fn inertial(node: &Node) -> Result<Inertial, UrdfError> {
    let mass = child(node, "mass").ok_or_else(|| missing(node, "<mass>"))?;
    let [mass_kg] = numbers(&mass, "value", None)?;
    if mass_kg < 0.0 {
        return Err(wrong(&mass, "value", "a mass of zero or more"));
    }
    let mut moments_kg_m2 = Matrix3::zeros();
    if let Some(inertia) = child(node, "inertia") {
        let at = |name| within(MOMENT_MAX, &inertia, name, Some([0.0])).map(|[moment]| moment);
        let (xy, xz, yz) = (at("ixy")?, at("ixz")?, at("iyz")?);
        let (xx, yy, zz) = (at("ixx")?, at("iyy")?, at("izz")?);
        moments_kg_m2 = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    }
    Ok(Inertial { mass_kg, origin: origin(node)?, moments_kg_m2 })
}

fn shape(solid: &Node) -> Result<Shape, UrdfError> {
    let geometry = child(solid, "geometry").ok_or_else(|| missing(solid, "<geometry>"))?;
    let first = geometry.children().find(Node::is_element);
    let node = first.ok_or_else(|| missing(&geometry, "shape"))?;
    match node.tag_name().name() {
        "box" => {
            let size: [f64; 3] = numbers(&node, "size", None)?;
            let fine = size.iter().all(|side| is_size(*side));
            let half_extents_m = Vector3::from(size) / 2.0;
            let shape = fine.then_some(Shape::Cuboid { half_extents_m });
            shape.ok_or_else(|| wrong(&node, "size", "three sides longer than zero, in metres"))
        }
        "cylinder" => Ok(Shape::Cylinder {
            radius_m: size(&node, "radius")?,
            length_m: size(&node, "length")?,
        }),
        "sphere" => Ok(Shape::Sphere { radius_m: size(&node, "radius")? }),
        "capsule" => Ok(Shape::Capsule {
            radius_m: size(&node, "radius")?,
            length_m: size(&node, "length")?,
        }),
        other => {
            let advice = "use boxes, cylinders, spheres and capsules in <collision>";
            Err(unsupported(&node, &format!("a <{}>", shortened(other)), advice))
        }
    }
}

fn joint(node: &Node, lines: &Lines) -> Result<JointElement, UrdfError> {
    let kind = attribute(node, "type")?;
    let of = |tag, name| -> Result<String, UrdfError> {
        let end = child(node, tag).ok_or_else(|| missing(node, tag))?;
        Ok(attribute(&end, name)?.to_owned())
    };
    let limit = child(node, "limit");
    let effort = limit.map(|limit| numbers(&limit, "effort", Some([0.0]))).transpose()?;
    let damped = child(node, "dynamics").is_some_and(|dynamics| {
        dynamics.attributes().any(|value| value.value().trim().parse() != Ok(0.0))
    });
    if let Some(mimic) = child(node, "mimic") {
        return Err(unsupported(&mimic, "a joint that follows another", "remove its <mimic>"));
    }
    Ok(JointElement {
        name: attribute(node, "name")?.to_owned(),
        line: lines.begun_at(node),
        kind: match kind {
            "fixed" => JointKind::Fixed,
            "revolute" | "continuous" => JointKind::Revolute(axis(node)?),
            other => {
                let advice = "its joints may be fixed, revolute or continuous";
                let what = format!("a joint of type {:?}", shortened(other));
                return Err(unsupported(node, &what, advice));
            }
        },
        parent: of("parent", "link")?,
        child: of("child", "link")?,
        origin: origin(node)?,
        effort_nm: effort.map_or(0.0, |[effort]| effort.abs()),
        is_limited: kind == "revolute",
        is_damped: damped,
    })
}

fn axis(joint: &Node) -> Result<Vector3<f64>, UrdfError> {
    let Some(node) = child(joint, "axis") else { return Ok(Vector3::x()) };
    let axis = Vector3::from(numbers(&node, "xyz", None)?);
    // What is a unit vector already keeps its bits.
    if (axis.norm_squared() - 1.0).abs() < 1e-15 {
        return Ok(axis);
    }
    let unit = UnitVector3::try_new(axis, 1e-9).map(UnitVector3::into_inner);
    unit.ok_or_else(|| wrong(&node, "xyz", "a direction"))
}

fn extension(node: &Node, lines: &Lines) -> Result<Extension, UrdfError> {
    let elements = |name| node.children().filter(move |child| child.has_tag_name(name));
    let [period_s] = numbers(node, "control-period", None)?;
    if !(1e-3..=10.0).contains(&period_s) {
        return Err(wrong(node, "control-period", "seconds from 0.001 to 10"));
    }
    let root = elements("root").next();
    Ok(Extension {
        period_s,
        root_rotation: root.map(|root| quaternion(&root, "rotation")).transpose()?,
        motors: elements("motor").map(|it| motor(&it, lines)).collect::<Result<_, _>>()?,
        poses: elements("pose").map(|pose| exact_pose(&pose)).collect::<Result<_, _>>()?,
    })
}

fn motor(node: &Node, lines: &Lines) -> Result<MotorElement, UrdfError> {
    let number = |name| numbers(node, name, None).map(|[number]| number);
    let waveform = attribute(node, "waveform")?.parse();
    let joint = attribute(node, "joint")?.to_owned();
    let wave = Wave {
        waveform: waveform.map_err(|_| wrong(node, "waveform", "sine, pulse or ramp"))?,
        amplitude_rad_s: number("amplitude")?,
        phase_start_rad: number("phase-start")?,
        phase_step_rad: number("phase-step")?,
    };
    Ok(MotorElement { joint, line: lines.begun_at(node), wave })
}

fn exact_pose(node: &Node) -> Result<ExactPose, UrdfError> {
    Ok(ExactPose {
        joint: attribute(node, "joint")?.to_owned(),
        parent_from_joint: pose(node, "joint-in-parent")?,
        joint_from_link: pose(node, "link-in-joint")?,
    })
}

fn pose(node: &Node, name: &'static str) -> Result<Isometry3<f64>, UrdfError> {
    let [x, y, z, i, j, k, w] = numbers(node, name, None)?;
    let rotation = unit(node, name, [i, j, k, w])?;
    Ok(Isometry3::from_parts(Translation3::new(x, y, z), rotation))
}

fn quaternion(node: &Node, name: &'static str) -> Result<UnitQuaternion<f64>, UrdfError> {
    unit(node, name, numbers(node, name, None)?)
}

/// A rotation that keeps its bits.
fn unit(
    node: &Node,
    name: &'static str,
    [i, j, k, w]: [f64; 4],
) -> Result<UnitQuaternion<f64>, UrdfError> {
    let quaternion = Quaternion::new(w, i, j, k);
    let fine = (quaternion.norm() - 1.0).abs() < 1e-9;
    let unit = fine.then(|| UnitQuaternion::new_unchecked(quaternion));
    unit.ok_or_else(|| wrong(node, name, "a rotation as a unit quaternion x y z w"))
}

fn origin(node: &Node) -> Result<Isometry3<f64>, UrdfError> {
    let Some(origin) = child(node, "origin") else { return Ok(Isometry3::identity()) };
    let [x, y, z] = numbers(&origin, "xyz", Some([0.0; 3]))?;
    let [roll, pitch, yaw] = numbers(&origin, "rpy", Some([0.0; 3]))?;
    Ok(Isometry3::from_parts(
        Translation3::from(vector![x, y, z]),
        UnitQuaternion::from_euler_angles(roll, pitch, yaw),
    ))
}

fn size(node: &Node, name: &'static str) -> Result<f64, UrdfError> {
    let [size] = numbers(node, name, None)?;
    is_size(size).then_some(size).ok_or_else(|| wrong(node, name, "metres over zero"))
}

fn is_size(metres: f64) -> bool {
    metres > 0.0
}

/// No number in a body of any use is larger: neither metres nor kilograms nor newton metres.
const NUMBER_MAX: f64 = 1e9;
/// No moment of inertia is larger, in kg·m².
const MOMENT_MAX: f64 = 1e30;

/// The numbers of an attribute, exactly so many of them.
fn numbers<const N: usize>(
    node: &Node,
    name: &'static str,
    default: Option<[f64; N]>,
) -> Result<[f64; N], UrdfError> {
    within(NUMBER_MAX, node, name, default)
}

/// The same, none larger than `most`.
fn within<const N: usize>(
    most: f64,
    node: &Node,
    name: &'static str,
    default: Option<[f64; N]>,
) -> Result<[f64; N], UrdfError> {
    let text = match (node.attribute(name), default) {
        (None, Some(default)) => return Ok(default),
        (None, None) => return Err(missing(node, name)),
        (Some(text), _) => text,
    };
    let parsed: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse).collect();
    let numbers = parsed.ok().and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
    let sane = numbers.filter(|all| all.iter().all(|number| number.abs() <= most));
    sane.ok_or_else(|| {
        wrong(node, name, if N == 1 { "a number" } else { "its numbers, with spaces between them" })
    })
}

fn child<'a, 'input>(node: &Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    node.children().find(|child| child.has_tag_name(name))
}

fn attribute<'a>(node: &Node<'a, '_>, name: &'static str) -> Result<&'a str, UrdfError> {
    node.attribute(name).ok_or_else(|| missing(node, name))
}

/// Where the lines of a document begin, in bytes. To count them anew for each element would take the square of its length.
struct Lines(Vec<usize>);

impl Lines {
    fn of(document: &Document) -> Self {
        let ends = document.input_text().bytes().enumerate().filter(|&(_, byte)| byte == b'\n');
        Self(std::iter::once(0).chain(ends.map(|(end, _)| end + 1)).collect())
    }

    /// The line that an element begins in, from 1.
    fn begun_at(&self, node: &Node) -> u32 {
        self.0.partition_point(|&begin| begin <= node.range().start) as u32
    }
}

/// The same for one element, which is wrong.
fn line(node: &Node) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

fn missing(node: &Node, what: &'static str) -> UrdfError {
    UrdfError::Missing { line: line(node), element: shortened(node.tag_name().name()), what }
}

fn wrong(node: &Node, attribute: &str, expected: &'static str) -> UrdfError {
    let value = shortened(node.attribute(attribute).unwrap_or_default());
    UrdfError::Attribute { line: line(node), attribute: attribute.to_owned(), value, expected }
}

fn unsupported(node: &Node, what: &str, advice: &'static str) -> UrdfError {
    UrdfError::Unsupported { line: line(node), what: what.to_owned(), advice }
}
