//! The arrangement of the viewer.

use super::card::RunCard;
use super::{PLAYBACK, ViewError, palette, scenery};
use rerun::blueprint::{
    BarChartView, Blueprint, BlueprintActivation, BlueprintPanel, ContainerLike, GraphView, Grid,
    Horizontal, SelectionPanel, Spatial3DView, Tabs, TextDocumentView, TextLogView, TimePanel,
    TimeSeriesView, Vertical,
};
use rerun::external::re_log_types::BlueprintActivationCommand;
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EyeControls3D, LineGrid3D, PlotLegend, TextLogColumns,
};
use rerun::external::re_sdk_types::blueprint::components::{
    BackgroundKind, Corner2D, LoopMode, PanelState, PlayState,
};
use rerun::external::re_sdk_types::blueprint::datatypes::{
    TextLogColumn, TextLogColumnKind, TimelineColumn,
};
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

/// A blueprint as messages for a sink.
pub fn messages(
    application: &ApplicationId,
    card: &RunCard,
    audience: Audience,
) -> Result<(Vec<LogMsg>, BlueprintActivationCommand), ViewError> {
    let mut layout = Layout::default();
    let panels =
        Horizontal::new([layout.stages(card), layout.figures(card)]).with_column_shares([3.0, 2.0]);
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
        let islands: Vec<u32> = (0..card.islands).collect();
        let pages: Vec<_> = islands.chunks(VIEWS_PER_PAGE as usize).collect();
        let mut tabs: Vec<ContainerLike> = Vec::new();
        for page in &pages {
            let name = match (page, pages.len()) {
                (_, 1) => "Champions".to_owned(),
                (page, _) => format!("Islands {}–{}", page[0], page[page.len() - 1]),
            };
            let columns = (page.len() as f64).sqrt().ceil() as u32;
            let views: Vec<_> = page.iter().map(|&island| self.island(island)).collect();
            tabs.push(Grid::new(views).with_name(name).with_grid_columns(columns).into());
        }
        tabs.push(self.race(card));
        Tabs::new(tabs).into()
    }

    fn island(&mut self, island: u32) -> ContainerLike {
        let view = Spatial3DView::new(format!("Island {island}"))
            .with_origin(format!("islands/{island}/follow"))
            .with_contents([
                format!("+ /islands/{island}/**"),
                format!("- /islands/{island}/lane"),
                format!("- /islands/{island}/follow/flag"),
            ]);
        let eye = EyeControls3D::new()
            .with_position([1.15, -1.92, 0.85])
            .with_look_target([0.0, 0.0, 0.05])
            .with_eye_up([0.0, 0.0, 1.0]);
        self.stage(view, &eye)
    }

    /// All islands' lanes side by side.
    fn race(&mut self, card: &RunCard) -> ContainerLike {
        let mut contents = vec!["+ /islands/**".to_owned(), "+ /race/**".to_owned()];
        contents.extend((0..card.islands).flat_map(|island| {
            ["ground", "follow/marker"].map(|name| format!("- /islands/{island}/{name}"))
        }));
        let view = Spatial3DView::new("Race").with_origin("/").with_contents(contents);
        let middle = scenery::middle_y(card.islands);
        let width = scenery::LANE_M * card.islands as f32;
        let eye = EyeControls3D::new()
            .with_position([-0.45 * width - 2.0, middle - 0.38 * width - 1.0, 0.42 * width + 2.0])
            .with_look_target([2.0, middle, 0.0])
            .with_eye_up([0.0, 0.0, 1.0]);
        self.stage(view, &eye)
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
        let unit = &card.unit;
        let best = self.curves(format!("Best fitness ({unit})"), "fitness/best", Corner2D::LeftTop);
        let mean = self.curves(format!("Mean fitness ({unit})"), "fitness/mean", Corner2D::LeftTop);
        let diversity = self.curves("Diversity".into(), "diversity", Corner2D::RightTop);
        let topology = GraphView::new("Topology").with_origin("topology");
        let spread = (0..card.islands).map(|island| {
            let view = BarChartView::new(format!("Spread {island}"));
            self.no_legend(view.with_origin(format!("population/{island}")))
        });
        let spread = Tabs::new(spread.collect::<Vec<_>>());
        let run = TextDocumentView::new("Run").with_origin("run");
        let both = Horizontal::new([topology.into(), spread.into()]);
        let words = Tabs::new([self.events(), run.into()]);
        Vertical::new([Tabs::new([best, mean]).into(), diversity, both.into(), words.into()])
            .with_row_shares([3.0, 2.0, 2.4, 2.2])
            .into()
    }

    fn curves(&mut self, name: String, origin: &str, legend: Corner2D) -> ContainerLike {
        let view = TimeSeriesView::new(name).with_origin(origin).into();
        self.set(&view, "PlotLegend", &PlotLegend::new().with_corner(legend));
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
        let time = TimelineColumn { visible: true.into(), timeline: PLAYBACK.into() };
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
