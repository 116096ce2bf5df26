//! What reading a scene has in hand, and the loop over its directives.

use super::definitions::Definitions;
use super::directive::{self, Directive, Side};
use super::include::Files;
use super::kinds::Kinds;
use super::mistakes::Mistakes;
use super::open_block::OpenBlock;
use super::options::Options;
use super::parameter::{Parameter, ParameterList, ParameterType, Values};
use super::parameter_syntax::{begins_directive, quotation};
use super::placement::Placement;
use super::scene::{Entity, Instance, Light, Material, Medium, Object, Shape, Texture};
use super::scene::{TextureId, TextureKind};
use super::settings::Settings;
use super::state::{GraphicsState, Inherited};
use super::statement::{self, Statement};
use super::tokens::{Cursor, Token, TokenKind};
use super::{ParseOptions, number};
use etalon_params::{Diagnostic, FileId, Sources, Span, Spanned};
use std::collections::HashMap;
use std::sync::Arc;

/// The state of reading one scene.
pub(crate) struct Reader<'o> {
    pub(crate) options: &'o ParseOptions,
    pub(crate) sources: Sources,
    pub(crate) mistakes: Mistakes,
    pub(crate) files: Files,
    /// The graphics state.
    pub(crate) state: GraphicsState,
    /// The blocks that are open, outermost first.
    pub(crate) blocks: Vec<OpenBlock>,
    /// How many of them an imported file cannot close, as they were open before it.
    pub(crate) floor: usize,
    /// Where `WorldBegin` stands.
    pub(crate) world: Option<Span>,
    /// Whether it was said that the world has not begun: once is enough.
    said_no_world: bool,
    pub(crate) settings: Settings,
    pub(crate) scene_options: Options,
    pub(crate) coordinate_systems: CoordinateSystems,
    pub(crate) shapes: Vec<Shape>,
    pub(crate) lights: Vec<Light>,
    pub(crate) instances: Vec<Instance>,
    /// The object that is being defined.
    pub(crate) open_object: Option<Object>,
    pub(crate) objects: Definitions<Object>,
    pub(crate) materials: Definitions<Material>,
    pub(crate) media: Definitions<Medium>,
    pub(crate) textures: Vec<Texture>,
    pub(crate) texture_ids: HashMap<(TextureKind, String), TextureId>,
    /// The names in parameters of the type `texture`, each where it first stands.
    pub(crate) texture_uses: HashMap<String, Span>,
}

/// Named coordinate systems. An imported file's own are forgotten at its end.
#[derive(Debug, Default)]
pub(crate) struct CoordinateSystems {
    pub(crate) placements: HashMap<String, Arc<Placement>>,
    /// What was replaced within imported files, with what stood there before.
    pub(crate) replaced: Vec<(String, Option<Arc<Placement>>)>,
}

impl<'o> Reader<'o> {
    pub(crate) fn new(options: &'o ParseOptions) -> Self {
        let mut materials = Definitions::new("material");
        let start = Span {
            file: FileId(0),
            start: 0,
            end: 0,
        };
        let default = Material {
            name: None,
            entity: Entity::bare("diffuse", start),
            mixed: Vec::new(),
        };
        let material = materials.keep(default, start);
        Self {
            options,
            sources: Sources::default(),
            mistakes: Mistakes::default(),
            files: Files::default(),
            state: GraphicsState::new(material),
            blocks: Vec::new(),
            floor: 0,
            world: None,
            said_no_world: false,
            settings: Settings::default(),
            scene_options: Options::default(),
            coordinate_systems: CoordinateSystems::default(),
            shapes: Vec::new(),
            lights: Vec::new(),
            instances: Vec::new(),
            open_object: None,
            objects: Definitions::new("object"),
            materials,
            media: Definitions::new("medium"),
            textures: Vec::new(),
            texture_ids: HashMap::new(),
            texture_uses: HashMap::new(),
        }
    }

    /// Reads the directives of a file.
    pub(crate) fn text(&mut self, file: FileId, text: &str) {
        let mut cursor = Cursor::new(text, file);
        while !self.mistakes.is_full()
            && let Some(token) = cursor.next()
        {
            if self.directive(&mut cursor, token).is_none() {
                skip_to_directive(&mut cursor);
            }
        }
    }

    /// Reads one directive. `None` if something of it may still stand before the cursor.
    fn directive(&mut self, cursor: &mut Cursor<'_>, token: Token<'_>) -> Option<()> {
        let found = match token.kind {
            TokenKind::Word => directive::find(token),
            _ => Err(not_a_directive(token)),
        };
        let directive = found.map_err(|mistake| self.report(mistake)).ok()?;
        let belongs_here = self.check_side(directive, token.span);
        let statement = statement::read(self, cursor, token, directive)?;
        if belongs_here {
            (directive.apply)(self, statement);
        }
        Some(())
    }

    /// Whether a directive stands on the side of `WorldBegin` where it counts.
    fn check_side(&mut self, directive: &Directive, word: Span) -> bool {
        let name = directive.name;
        match (directive.side, self.world) {
            (Side::Options, Some(begin)) => {
                let message = match name {
                    "WorldBegin" => "`WorldBegin` is given twice".to_owned(),
                    _ => format!("`{name}` must stand before `WorldBegin`"),
                };
                let mistake = Diagnostic::error(word, message);
                self.report(mistake.related(begin, "the world begins here"));
                false
            }
            (Side::World, None) => {
                if !self.said_no_world {
                    let message = format!("`{name}` must stand after `WorldBegin`");
                    let mistake = Diagnostic::error(word, message);
                    self.report(mistake.label("the world has not begun"));
                }
                self.said_no_world = true;
                true
            }
            _ => true,
        }
    }

    /// Whether it has been said that something stands outside of the world.
    pub(crate) fn said_no_world(&self) -> bool {
        self.said_no_world
    }

    /// Records a message.
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        self.mistakes.report(diagnostic);
    }

    /// The type of a name; that there is none is reported.
    pub(crate) fn kind(&mut self, kinds: &Kinds, name: &Spanned<String>) -> Option<&'static str> {
        let found = kinds.find(name);
        found.map_err(|mistake| self.report(mistake)).ok()
    }

    /// An entity with the parameters of a statement.
    pub(crate) fn entity(
        &mut self,
        kind: &'static str,
        statement: Statement,
        inherited: &Inherited,
    ) -> Entity {
        let own = statement.parameters.into_boxed_slice();
        self.note_textures(own.iter());
        Entity {
            kind,
            span: statement.word,
            params: ParameterList {
                own,
                inherited: inherited.clone(),
            },
        }
    }

    /// Notes the textures that parameters name, which must be there in the end.
    pub(crate) fn note_textures<'p>(&mut self, parameters: impl Iterator<Item = &'p Parameter>) {
        for parameter in parameters.filter(|p| p.kind == ParameterType::Texture) {
            let Values::Strings(names) = &parameter.values else {
                continue;
            };
            for name in names {
                if !self.texture_uses.contains_key(&name.value) {
                    self.texture_uses.insert(name.value.clone(), name.span);
                }
            }
        }
    }
}

/// Moves to the next directive, or to the end.
fn skip_to_directive(cursor: &mut Cursor<'_>) {
    while let Some(token) = cursor.peek() {
        if begins_directive(token) {
            return;
        }
        cursor.next();
    }
}

fn not_a_directive(token: Token<'_>) -> Diagnostic {
    let found = match token.kind {
        TokenKind::Quoted => format!("the string `{}`", quotation(token)),
        _ => format!("`{}`", number::excerpt(token.text)),
    };
    let message = format!("expected a directive, found {found}");
    Diagnostic::error(token.span, message)
}
