//! The arrangement of the viewer.

use super::card::{Program, RunCard};
use super::{GENERATION, PLAYBACK, ViewError, palette, race};
use rerun::blueprint::{
    BarChartView, Blueprint, BlueprintActivation, BlueprintPanel, ContainerLike, GraphView, Grid,
    Horizontal, SelectionPanel, Spatial3DView, StateTimelineView, Tabs, TextDocumentView,
    TextLogView, TimePanel, TimeSeriesView, Vertical,
};
use rerun::external::re_log_types::BlueprintActivationCommand;
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EyeControls3D, LineGrid3D, PlotLegend, TextLogColumns, TimeAxis,
};
use rerun::external::re_sdk_types::blueprint::components::{
    BackgroundKind, Corner2D, LoopMode, PanelState, PlayState,
};
use rerun::external::re_sdk_types::blueprint::datatypes::{
    TextLogColumn, TextLogColumnKind, TimelineColumn,
};
use rerun::external::re_sdk_types::datatypes::{TimeRange, TimeRangeBoundary};
use rerun::log::LogMsg;
use rerun::{
    ApplicationId, AsComponents, EntityPath, RecordingStreamBuilder, SerializedComponentBatch,
    StoreKind,
};

/// Who looks at a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Audience {
    /// Someone who opens a file: it plays in a loop.
    File,
    /// Someone who watches a run: at the end of what there is the film waits for more.
    Live,
}

/// More views than this on one page are too small to see anything.
const VIEWS_PER_PAGE: u32 = 9;

/// The legend of more curves than this hides them.
const LEGEND_MAX: u32 = 6;

/// A blueprint as messages for a sink.
pub fn messages(
    application: &ApplicationId,
    card: &RunCard,
    audience: Audience,
) -> Result<(Vec<LogMsg>, BlueprintActivationCommand), ViewError> {
    let mut layout = Layout::default();
    let [left, right] = match card.has_stage {
        true => [layout.stages(card), layout.figures(card)],
        false => layout.figures_alone(card),
    };
    let panels = Horizontal::new([left, right]).with_column_shares([3.0, 2.0]);
    let blueprint = Blueprint::new(panels)
        .with_auto_layout(false)
        .with_auto_views(false)
        .with_blueprint_panel(BlueprintPanel::from_state(PanelState::Collapsed))
        .with_selection_panel(SelectionPanel::from_state(PanelState::Collapsed))
        .with_time_panel(clock(audience));

    // The blueprint names its store only when it is sent; a stream in memory catches it.
    let (catcher, caught) = RecordingStreamBuilder::new(application.clone()).memory()?;
    blueprint.send(&catcher, BlueprintActivation::default())?;
    let mut messages = Vec::new();
    let mut activation = None;
    for message in caught.take() {
        match message {
            LogMsg::BlueprintActivationCommand(command) => activation = Some(command),
            message if message.store_id().kind() == StoreKind::Blueprint => messages.push(message),
            _ => {}
        }
    }
    let activation = activation.expect("a blueprint that is sent is activated");
    messages.extend(layout.settings(&activation)?);
    Ok((messages, activation))
}

/// An eye beside a champion, a little ahead, in a frame as large as its body.
fn companion() -> EyeControls3D {
    EyeControls3D::new()
        .with_position([0.95, -1.85, 0.8])
        .with_look_target([0.05, 0.0, 0.02])
        .with_eye_up([0.0, 0.0, 1.0])
}

/// A name, and the unit of fitness if it has one.
fn with_unit(name: &str, card: &RunCard) -> String {
    if card.unit.is_empty() { name.to_owned() } else { format!("{name} ({})", card.unit) }
}

/// From the beginning to the end, wherever the film is.
fn whole_film() -> TimeAxis {
    TimeAxis::new().with_view_range(TimeRange {
        start: TimeRangeBoundary::Infinite,
        end: TimeRangeBoundary::Infinite,
    })
}

fn clock(audience: Audience) -> TimePanel {
    let loop_mode = match audience {
        Audience::File => LoopMode::All,
        Audience::Live => LoopMode::Off,
    };
    TimePanel::new()
        .with_state(PanelState::Collapsed)
        .with_timeline(PLAYBACK)
        .with_play_state(PlayState::Playing)
        .with_loop_mode(loop_mode)
}

/// Views, and the settings of them that Rerun's blueprint types have no method for.
#[derive(Default)]
struct Layout {
    settings: Vec<(EntityPath, Vec<SerializedComponentBatch>)>,
}

impl Layout {
    /// The left side: creatures.
    fn stages(&mut self, card: &RunCard) -> ContainerLike {
        let mut tabs = match card.program {
            Program::Run | Program::Race => self.pages(card),
            Program::Line => vec![self.line(card)],
        };
        tabs.push(self.race(card));
        if card.has_family {
            tabs.push(GraphView::new("Family").with_origin("family").into());
        }
        Tabs::new(tabs).into()
    }

    /// Each lane in a view of its own.
    fn pages(&mut self, card: &RunCard) -> Vec<ContainerLike> {
        let lanes: Vec<u32> = (0..card.lane_count()).collect();
        let pages: Vec<_> = lanes.chunks(VIEWS_PER_PAGE as usize).collect();
        let name = |page: &[u32]| match pages.len() {
            1 => "Champions".to_owned(),
            _ => format!("Champions {}–{}", page[0], page[page.len() - 1]),
        };
        let page = |page: &&[u32]| {
            let columns = (page.len() as f64).sqrt().ceil() as u32;
            let views: Vec<_> = page.iter().map(|&lane| self.lane(card, lane)).collect();
            Grid::new(views).with_name(name(page)).with_grid_columns(columns).into()
        };
        pages.iter().map(page).collect()
    }

    fn lane(&mut self, card: &RunCard, lane: u32) -> ContainerLike {
        let view = Spatial3DView::new(card.lanes[lane as usize].title.as_str())
            .with_origin(format!("islands/{lane}/follow"))
            .with_contents([
                format!("+ /islands/{lane}/**"),
                format!("- /islands/{lane}/follow/flag"),
            ]);
        self.stage(view, &companion())
    }

    /// Who is on its way, among those who came before.
    fn line(&mut self, card: &RunCard) -> ContainerLike {
        let mut contents = vec!["+ /islands/**".to_owned(), "+ /race/lanes/**".to_owned()];
        contents.extend((0..card.lane_count()).flat_map(|lane| {
            ["ground/**", "follow/flag"].map(|name| format!("- /islands/{lane}/{name}"))
        }));
        let view = Spatial3DView::new("One by one").with_origin("line/follow");
        self.stage(view.with_contents(contents), &companion())
    }

    /// All lanes side by side, seen from the right.
    fn race(&mut self, card: &RunCard) -> ContainerLike {
        let lanes = card.lane_count();
        let mut contents = vec!["+ /islands/**".to_owned(), "+ /race/**".to_owned()];
        contents.extend((0..lanes).flat_map(|lane| {
            ["ground/**", "ruler", "follow/marker"].map(|name| format!("- /islands/{lane}/{name}"))
        }));
        let view = Spatial3DView::new("Race").with_origin(race::FRAME).with_contents(contents);
        self.stage(view, &race::eye(card))
    }

    fn stage(&mut self, view: Spatial3DView, eye: &EyeControls3D) -> ContainerLike {
        let view = ContainerLike::from(view);
        let dark = Background::new(BackgroundKind::SolidColor)
            .with_color(palette::opaque(palette::BACKDROP));
        self.set(&view, "EyeControls3D", eye);
        self.set(&view, "Background", &dark);
        self.set(&view, "LineGrid3D", &LineGrid3D::new().with_visible(false));
        view
    }

    /// The right side: numbers and words.
    fn figures(&mut self, card: &RunCard) -> ContainerLike {
        let run = TextDocumentView::new("Run").with_origin("run").into();
        let unit = &card.unit;
        match card.program {
            Program::Run => self.figures_of_run(card, run),
            Program::Race => {
                let distance = self.curves(card, format!("Distance ({unit})"), "distance");
                let speed = self.curves(card, format!("Speed ({unit}/s)"), "speed");
                Vertical::new([distance, speed, run]).with_row_shares([3.0, 2.0, 2.2]).into()
            }
            Program::Line => {
                let fitness = self.curves(card, format!("Fitness ({unit})"), "fitness/line");
                let distance = self.curves(card, format!("Distance ({unit})"), "distance");
                let speed = self.curves(card, format!("Speed ({unit}/s)"), "speed");
                let all = [fitness, distance, speed, run];
                Vertical::new(all).with_row_shares([2.4, 2.0, 1.6, 2.4]).into()
            }
        }
    }

    fn figures_of_run(&mut self, card: &RunCard, run: ContainerLike) -> ContainerLike {
        let (curves, diversity) = self.growth(card);
        let (both, words) = (self.islands(card), self.words(run));
        Vertical::new([curves, diversity, both, words]).with_row_shares([3.0, 2.0, 2.4, 2.2]).into()
    }

    /// Both sides of a run in which there is nothing to be seen but figures.
    fn figures_alone(&mut self, card: &RunCard) -> [ContainerLike; 2] {
        let (curves, diversity) = self.growth(card);
        let run = TextDocumentView::new("Run").with_origin("run").into();
        let family = GraphView::new("Family").with_origin("family").into();
        let (both, words) = (self.islands(card), self.words(run));
        let left = Vertical::new([curves, diversity]).with_row_shares([3.0, 2.0]);
        let right = Vertical::new([family, both, words]).with_row_shares([2.4, 2.0, 2.4]);
        [left.into(), right.into()]
    }

    /// The best and the mean fitness, and the diversity.
    fn growth(&mut self, card: &RunCard) -> (ContainerLike, ContainerLike) {
        let best = self.curves(card, with_unit("Best fitness", card), "fitness/best");
        let mean = self.curves(card, with_unit("Mean fitness", card), "fitness/mean");
        let diversity =
            self.curves(card, "Diversity (mean distance of genomes, 0–1)".into(), "diversity");
        (Tabs::new([best, mean]).into(), diversity)
    }

    /// Who sends to whom, and each population's scores.
    fn islands(&mut self, card: &RunCard) -> ContainerLike {
        let topology = GraphView::new("Topology").with_origin("topology").into();
        let spread = card.lanes().map(|(island, _)| {
            let view = BarChartView::new(with_unit(&format!("Spread {island}"), card));
            self.no_legend(view.with_origin(format!("population/{island}")))
        });
        let spread = Tabs::new(spread.collect::<Vec<_>>());
        Horizontal::new([topology, spread.into()]).into()
    }

    fn words(&mut self, run: ContainerLike) -> ContainerLike {
        let states = StateTimelineView::new("Island state").with_origin("state").into();
        self.set(&states, "TimeAxis", &whole_film());
        Tabs::new([self.events(), states, run]).into()
    }

    /// Curves over the whole film, whose legend is left out where it would hide them.
    fn curves(&mut self, card: &RunCard, name: String, origin: &str) -> ContainerLike {
        let view = TimeSeriesView::new(name).with_origin(origin).into();
        let is_legible = (2..=LEGEND_MAX).contains(&card.lane_count());
        let corner = if origin == "diversity" { Corner2D::RightTop } else { Corner2D::LeftTop };
        let legend = PlotLegend::new().with_corner(corner).with_visible(is_legible);
        self.set(&view, "PlotLegend", &legend);
        self.set(&view, "TimeAxis", &whole_film());
        view
    }

    /// Bars of one colour, which the tab names.
    fn no_legend(&mut self, view: BarChartView) -> ContainerLike {
        let view = view.into();
        self.set(&view, "PlotLegend", &PlotLegend::new().with_visible(false));
        view
    }

    /// The events without the columns that say nothing.
    fn events(&mut self) -> ContainerLike {
        let view = TextLogView::new("Events").with_origin("events").into();
        let time = TimelineColumn { visible: true.into(), timeline: GENERATION.into() };
        let body = TextLogColumn { visible: true.into(), kind: TextLogColumnKind::Body };
        let columns =
            TextLogColumns::new().with_timeline_columns([time]).with_text_log_columns([body]);
        self.set(&view, "TextLogColumns", &columns);
        view
    }

    fn set(&mut self, view: &ContainerLike, property: &str, value: &dyn AsComponents) {
        if let ContainerLike::View(view) = view {
            let path = view.blueprint_path().join(&EntityPath::from(property));
            self.settings.push((path, value.as_serialized_batches()));
        }
    }

    /// The settings as messages for the blueprint's store.
    fn settings(self, activation: &BlueprintActivationCommand) -> Result<Vec<LogMsg>, ViewError> {
        let (stream, storage) = RecordingStreamBuilder::from_store_id(&activation.blueprint_id)
            .send_properties(false)
            .memory()?;
        stream.set_time_sequence("blueprint", 0);
        for (path, batches) in self.settings {
            stream.log_serialized_batches(path, false, batches)?;
        }
        Ok(storage.take())
    }
}
