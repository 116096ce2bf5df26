"""Etalon renders scenes with their statistical errors, and decides whether pictures agree."""

import os
from typing import Any, Callable, Dict, Iterable, Iterator, List, Literal, Optional, Sequence, Tuple, TypedDict, Union, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "Comparison",
    "Conformance",
    "Estimator",
    "EstimatorComparison",
    "Image",
    "Scene",
    "SceneError",
    "Transform",
    "compare",
    "conform",
    "denoise",
    "dict_to_xml",
    "estimators",
    "load_dict",
    "load_file",
    "load_string",
    "merge",
    "read",
    "render",
]

_Path = Union[str, os.PathLike[str]]

__version__: str

class _Diagnostic(TypedDict):
    """A message about a scene; line and column count from 1, None where it has no place.

    `key` is the path of keys in a dict, such as 'cube.bsdf.reflectance'; line and column are then those of `dict_to_xml`.
    """

    severity: Literal["error", "note"]
    message: str
    help: Optional[str]
    key: Optional[str]
    file: Optional[str]
    line: Optional[int]
    column: Optional[int]

class SceneError(ValueError):
    """A scene has mistakes; the message has a line `file:line:column: error: …` or `key.path: error: …` for each."""

    diagnostics: List[_Diagnostic]

@final
class Scene:
    """A scene that is ready to be rendered, as made by `load_file`, `load_string` and `load_dict`."""

    @property
    def integrator(self) -> str:
        """The integrator's name, nested ones after a slash, such as 'path' or 'aov/path'."""
    @property
    def size(self) -> Tuple[int, int]:
        """Width and height of what is rendered (pixels)."""
    @property
    def notes(self) -> List[str]:
        """Remarks about the scene that do not prevent rendering, each `file:line:column: note: …` or `key.path: note: …`."""
    @property
    def defines(self) -> Dict[str, str]:
        """The scene's `$parameters` with the values that count, as texts, in the order of the file."""
    def parameters(self, *, arrays: bool = False) -> Dict[str, Any]:
        """The values of the scene's plugins, by paths of keys such as 'ball.bsdf.reflectance', as far as they are given.

        A key is a name, or else an `id`, or else a type ('sphere', 'sphere_2', …); an object that several others share has
        its shortest path. Numbers, texts, and arrays: 3 for points, vectors and colours, n × 2 for spectra (nm, value),
        4 × 4 for transforms. Names of files and animations are left out.

        arrays: whether what is in files is there, too, as copies: `data` of pictures (bytes as uint8, others linear float32)
        and volumes, and of meshes `vertices`, `faces`, `normals`, `uv` and attributes, all as in `load_dict`.
        """
    def with_parameters(self, parameters: Dict[str, Any]) -> Scene:
        """The scene with other values: by paths as in `parameters()`, or of parameters that are not given yet.

        This scene stays as it is. What is read for the first change, files included, stays in memory for further ones.
        A value is as in `load_dict`; three numbers in place of a colour, number or texture are a colour; arrays, such as
        'wall.vertices' or 'wall.bsdf.reflectance.data', are in place of those in files. Vertices that move get new normals,
        unless these are given; with `vertices` and `faces` it is another mesh, of which nothing old remains.
        Raises SceneError with every mistake, each with its path.
        """

@final
class Image:
    """A picture with its standard errors and metadata."""

    def numpy(self) -> NDArray[np.float32]:
        """The colour: height × width × 3, linear Rec. 709 in the scene's units of radiance."""
    def standard_error(self) -> NDArray[np.float32]:
        """The standard error of `numpy()`: height × width × 3, in the same units.

        Raises ValueError if there is a single replicate, or if the channels are neither R, G, B nor Y.
        """
    def channel(self, name: str) -> NDArray[np.float32]:
        """One channel, by its name in the file: height × width."""
    def tiles(self, side: int = 16, confidence: float = 0.99) -> NDArray[np.float64]:
        """The means of tiles of 16 × 16 or 64 × 64 pixels with intervals of this confidence.

        rows × columns × colours × 3: the mean over replicates, and the lower and upper end of its interval.
        """
    def save(self, path: _Path) -> None:
        """Writes an image with everything (.exr; a part that `merge` takes if it is one), or a picture to look at (.png)."""
    @staticmethod
    def from_replicates(pictures: Iterable[ArrayLike], *, spp: int = 1, program: str = "") -> Image:
        """Pictures of one scene with different, independent seeds, by any renderer, as one image with its errors.

        Each is an array of height × width × 3, linear Rec. 709, of `spp` samples per pixel.
        """
    def _repr_png_(self) -> Optional[bytes]: ...
    @property
    def channels(self) -> List[str]:
        """The names of all channels, `standard_error.*` included."""
    @property
    def size(self) -> Tuple[int, int]:
        """Width and height (pixels)."""
    @property
    def notes(self) -> List[str]:
        """What the renderer has to say about the picture."""
    @property
    def mean_relative_standard_error(self) -> Optional[float]:
        """√ of the mean of s² / (m² + 0.01) over pixels and colours, with mean m and standard error s."""
    @property
    def relative_standard_error(self) -> Optional[float]:
        """√(Σ ⟨s²⟩ / Σ m²), with means over the image of each colour and of s², and sums over colours; None if it is black."""
    @property
    def metadata(self) -> Dict[str, Any]:
        """Version, scene, integrator, sampler, spp, replicates, seed, film, …; empty for pictures of other programs."""

@final
class Comparison:
    """What came of comparing two images; true if they are equivalent."""

    @property
    def verdict(self) -> Literal["equivalent", "different", "inconclusive"]:
        """The verdict; the last is never a pass."""
    @property
    def interval(self) -> Optional[Tuple[float, float]]:
        """The interval of the relative bias of the image's mean, of the channel where it reaches farthest."""
    @property
    def p_value(self) -> Optional[float]:
        """That of "both are estimates of the very same picture", over all questions (Bonferroni)."""
    @property
    def p_values(self) -> Dict[str, float]:
        """For each channel that of "no bias at all" of the image's mean, not corrected."""
    @property
    def more_samples(self) -> Optional[float]:
        """How many times as many samples, in both images, would decide what is open; None if nothing is."""
    @property
    def notes(self) -> List[str]:
        """What one should know to read the verdict: why the images cannot be judged, a seed that both share, …"""
    def report(self, path: _Path) -> None:
        """Writes a self-contained page (HTML)."""
    def __bool__(self) -> bool: ...

@final
class Estimator:
    """What was found about one estimator; figures are of one picture of `spp` samples per pixel, at equal time."""

    @property
    def name(self) -> str:
        """What tells it from the others, such as 'path' or 'path, sobol'."""
    @property
    def spp(self) -> int:
        """Samples per pixel of one picture."""
    @property
    def pictures(self) -> int:
        """Independent pictures that were rendered at equal time."""
    @property
    def mean(self) -> Tuple[float, float, float]:
        """The means of red, green and blue over the image and all pictures (linear Rec. 709, the scene's units)."""
    @property
    def relative_mse(self) -> Optional[float]:
        """The mean of (x − r)² / (r² + 0.01) with the reference r, of one picture."""
    @property
    def variance(self) -> Optional[float]:
        """The part of `relative_mse` that is variance."""
    @property
    def bias_squared(self) -> Optional[float]:
        """The part of `relative_mse` that is bias; an unbiased estimate, which may be negative."""
    @property
    def seconds(self) -> Optional[float]:
        """The time of one picture (s)."""
    @property
    def efficiency(self) -> Optional[float]:
        """1 / (relative_mse · seconds), in s⁻¹."""
    @property
    def gain(self) -> Optional[float]:
        """How many times as efficient as the first estimator; None of the first."""
    @property
    def intervals(self) -> Dict[str, Optional[Tuple[float, float]]]:
        """The intervals of 95 % of these figures, by name; None where there is none."""
    @property
    def differences(self) -> Dict[str, Optional[Tuple[float, float]]]:
        """For each channel the interval of the relative difference from the first estimator's mean; empty of the first."""

@final
class EstimatorComparison:
    """What came of comparing estimators: a mapping from their names; true if all have the same mean within the tolerance."""

    @property
    def verdict(self) -> Literal["equivalent", "different", "inconclusive"]:
        """Whether the intervals of all differences between means lie within the tolerance, or one outside."""
    @property
    def notes(self) -> List[str]:
        """What one should know before believing the figures."""
    @property
    def findings(self) -> Dict[str, Any]:
        """Everything that was found, as docs/estimators-json.md has it."""
    def keys(self) -> List[str]:
        """The names; the others are compared to the first."""
    def report(self, path: _Path) -> None:
        """Writes a self-contained page (HTML)."""
    def __getitem__(self, name: str, /) -> Estimator: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[str]: ...
    def __bool__(self) -> bool: ...

@final
class Conformance:
    """What a renderer answered; true if it agrees in all that it can express."""

    @property
    def verdict(self) -> Literal["agrees", "differs", "broken", "undecided"]:
        """The worst that was found, if not all agrees; 'undecided' is never a pass."""
    @property
    def verdicts(self) -> Dict[str, Literal["agrees", "differs", "broken", "undecided", "not supported"]]:
        """For each question."""
    @property
    def findings(self) -> Dict[str, Any]:
        """Everything that was found, as the `report.json` of `etalon conform run` has it."""
    def report(self, path: _Path) -> None:
        """Writes a self-contained page (HTML)."""
    def __bool__(self) -> bool: ...

def load_file(path: _Path, **defines: object) -> Scene:
    """Reads a scene of Mitsuba's XML, pbrt-v4 or glTF, as the ending of its file tells.

    `defines` are values of its `$parameters`. Raises SceneError with every mistake in it.
    """

def load_string(xml: str, **defines: object) -> Scene:
    """Reads a scene from a text of Mitsuba's XML; relative files are looked for in the current folder."""

def load_dict(dict: Dict[str, Any]) -> Scene:
    """Reads a scene from a dict in Mitsuba 3's manner: {'type': 'scene', …}.

    Its keys are names; a dict within is an object with the plugin of its `type`.
    - {'type': 'ref', 'id': …} is another object, by its `id`, its key or its path of keys ('ball.bsdf').
    - {'type': 'rgb', 'value': [r, g, b]} or of one number; {'type': 'spectrum', 'value': …} of a number or pairs of
      wavelength (nm) and value, or with a `filename`.
    - Three numbers are a point or vector; a `Transform`, 4 × 4 numbers or an object with such a `matrix` a transform;
      for `to_uv` also 3 × 3. Strings and paths are strings. Nothing is a `$parameter`.
    - {'type': 'animation', 'keys': [(time, value), …]}, possibly with an `interpolation`, is a value that changes.
    - {'type': 'resources', 'path': …} is a folder to look for files in; they are also looked for in the current one.

    Arrays, which are copied:
    - `data` (or `bitmap`) of a `bitmap`, `envmap`, `goniometric` or `heightfield`: height × width, or × 1, 3 or 4
      channels, top row first; floats are linear, uint8 is sRGB unless `raw`.
    - `data` (or `grid`) of a `gridvolume` or `sdfgrid`: z × y × x, or × 1, 3 or 6 channels.
    - {'type': 'mesh'}: `vertices` N × 3 (m), `faces` M × 3 (indices from 0), and possibly `normals` N × 3, `uv` N × 2 and
      attributes `vertex_…` or `face_…` of one or three numbers each; `vertex_positions`, `vertex_normals` and
      `vertex_texcoords` are other names. All may be flat.

    Raises SceneError with every mistake in it, each with its path of keys.
    """

def dict_to_xml(dict: Dict[str, Any]) -> str:
    """The text of Mitsuba's XML that a dict stands for.

    Raises SceneError if it has arrays, which no text can hold, or values that cannot be written.
    """

@final
class Transform:
    """An affine transform, which acts on columns: `a @ b` is b and then a.

    Transform() is the identity; its methods multiply from the right, as Mitsuba's:
    `Transform().translate([0, 0, 1]).rotate([0, 0, 1], 45)` rotates first.
    """

    def __new__(cls, matrix: Optional[ArrayLike] = None) -> Transform: ...
    def translate(self, vector: ArrayLike) -> Transform:
        """Moves by three numbers (m)."""
    def scale(self, factors: ArrayLike) -> Transform:
        """Scales by one factor, or by one along each axis."""
    def rotate(self, axis: ArrayLike, angle: float) -> Transform:
        """Rotates about an axis by an angle (°), counter-clockwise seen against it."""
    def look_at(self, origin: ArrayLike, target: ArrayLike, up: Optional[ArrayLike] = None) -> Transform:
        """The frame of a camera or shape at `origin` whose +z looks at `target`, with +y on the side of `up`."""
    def inverse(self) -> Transform:
        """The transform that undoes it."""
    @property
    def matrix(self) -> NDArray[np.float64]:
        """4 × 4."""
    def __matmul__(self, other: Transform, /) -> Transform: ...
    def __rmatmul__(self, other: Transform, /) -> Transform: ...

def render(
    scene: Scene,
    spp: Optional[int] = None,
    seed: Optional[int] = None,
    *,
    error: Optional[float] = None,
    seconds: Optional[float] = None,
    replicates: Optional[int] = None,
    integrator: Optional[str] = None,
    size: Optional[Tuple[int, int]] = None,
    crop: Optional[Tuple[int, int, int, int]] = None,
    time: Optional[float] = None,
    features: bool = False,
    part: Optional[Tuple[int, int]] = None,
    threads: Optional[int] = None,
    progress: Union[None, bool, Callable[[float], object]] = None,
) -> Image:
    """Renders a scene; what is None is as the scene has it.

    spp: samples per pixel, all replicates together.
    seed: the same one gives the same bits, whatever the threads, and those of the binary.
    error: in place of spp, the `relative_standard_error` to reach (10⁻⁶ to 1). A pilot fixes how many samples are needed, and
        is no part of the image; `notes` says so if the error is missed, as it is in one case of twenty or so.
    seconds: in place of spp, about how long to render (s), pilot included.
    replicates: independent estimates whose spread makes the standard error; 8 or somewhat more if None.
    integrator: a type for the innermost integrator.
    size: width and height of the whole film (pixels).
    crop: x, y, width and height of the part to render, with the bits that it has in the whole.
    time: the moment that the shutter counts from (units of scene time).
    features: whether the image gets the channels that `denoise` needs.
    part: (k, n): the k-th of n shares of the replicates alone, to be put together by `merge`.
    threads: as many as there are processors if None.
    progress: called with the fraction done, or True for a line on standard error.

    Ctrl-C stops the render and raises KeyboardInterrupt.
    """

def read(path: _Path) -> Image:
    """Reads an EXR file, of Etalon or another program."""

def merge(parts: Iterable[Union[Image, _Path]], *, partial: bool = False) -> Image:
    """Puts the parts of an image together, as `render(…, part=(k, n))` and `etalon render --part k/n` make them.

    parts: images or files, in any order. The result has the bits of a render that was not split.
    partial: whether replicates may be missing; the result is a larger part then.
    Raises ValueError for what is no part, parts of different renders or with common replicates, and missing replicates.
    """

def denoise(image: Union[Image, _Path], *, oidn: Union[None, bool, _Path] = None) -> Image:
    """Denoises an image that was rendered with `features=True` (`etalon render --features`).

    `standard_error()` of the result estimates its root mean square error, bias included. It has no replicates, and
    `compare` makes no verdict of it.
    oidn: True, or a path to it, to let Intel's Open Image Denoise 2 filter.
    Raises ValueError if the image lacks the features, or the library is not found.
    """

def compare(
    a: Union[Image, _Path],
    b: Union[Image, _Path],
    tolerance: float = 0.005,
    *,
    tile_tolerance: float = 0.03,
    alpha: float = 0.001,
) -> Comparison:
    """Decides whether two images, or the files of two, are equivalent.

    tolerance: the bias of an image's mean that would matter, relative to the channel's mean.
    tile_tolerance: that of a tile, relative to its own mean (plus `tolerance` of the image's).
    alpha: the probability of calling equal images different, over everything that is asked.
    """

def estimators(
    scene: Scene,
    integrators: Optional[Sequence[str]] = None,
    *,
    seconds: float,
    samplers: Optional[Sequence[str]] = None,
    filters: Optional[Sequence[str]] = None,
    tolerance: float = 0.01,
    reference: Optional[_Path] = None,
    seed: int = 0,
    threads: Optional[int] = None,
    progress: Union[None, bool, Callable[[float], object]] = None,
) -> EstimatorComparison:
    """Compares estimators on a scene: their means, errors, times and efficiencies, each with its interval.

    integrators, samplers, filters: names to combine; the scene's own if None. Two estimators or more.
    seconds: the time for all rendering together (s).
    tolerance: the difference of means that would matter, relative.
    reference: the file of a converged image to measure errors against, instead of one by the first estimator.
    Raises SceneError for what the scene cannot be rendered with, and ValueError if the time is not enough.
    """

def conform(
    driver: _Path,
    output: _Path,
    *,
    questions: Optional[Sequence[str]] = None,
    tier: Literal["quick", "standard", "full"] = "standard",
    workers: Optional[int] = None,
    limit: int = 120,
    python: Optional[_Path] = None,
    etalon: Optional[_Path] = None,
) -> Conformance:
    """Asks a renderer questions with known answers.

    driver: a TOML file that says how to run it (docs/testing-a-renderer.md), or the name of a driver that comes with Etalon.
    output: the folder for scenes and pictures; those that are there already are not rendered again.
    questions: their names; all if None.
    workers: pictures at a time, each with one thread; as many as there are processors if None.
    limit: the longest that a picture may take (s).
    python, etalon: the programs that drivers call so; this Python and the binary on the PATH if None.

    Ctrl-C waits for the pictures that are being rendered. Raises ValueError for what cannot be run or written.
    """
