//! Embree 4 as an opponent, loaded at run time: Intel's ray tracing kernels, by their C interface
//! (<https://github.com/RenderKit/embree>, `include/embree4`). Nothing is linked; without the library its rows are left out.
//!
//! The device is asked for AVX2, which is what Etalon is compiled for; scenes are `ROBUST` (edges are watertight), the
//! build's quality is `MEDIUM`, its default. Rays are traced one by one with `rtcIntersect1` and `rtcOccluded1`.

#![expect(unsafe_code, reason = "the interface of a C library")]

use crate::scenes::{Object, Scene};
use core::error::Error;
use core::ffi::{c_char, c_int, c_uint, c_void};
use core::mem::offset_of;
use core::ptr;
use core::sync::atomic::{AtomicI64, Ordering};
use etalon_math::Mat4;
use etalon_transport::{MeshData, Ray};
use libloading::Library;
use std::env;
use std::ffi::{CString, OsString};
use std::fs;
use std::path::{Path, PathBuf};

type Handle = *mut c_void;
type Monitor = extern "C" fn(Handle, isize, bool) -> bool;

/// The constants of Embree's headers, by the names there.
const RTC_GEOMETRY_TYPE_TRIANGLE: c_int = 0;
const RTC_GEOMETRY_TYPE_SPHERE_POINT: c_int = 50;
const RTC_GEOMETRY_TYPE_INSTANCE: c_int = 121;
const RTC_BUFFER_TYPE_INDEX: c_int = 0;
const RTC_BUFFER_TYPE_VERTEX: c_int = 1;
const RTC_FORMAT_UINT3: c_int = 0x5003;
const RTC_FORMAT_FLOAT3: c_int = 0x9003;
const RTC_FORMAT_FLOAT4: c_int = 0x9004;
const RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR: c_int = 0x9244;
const RTC_SCENE_FLAG_ROBUST: c_int = 4;
const RTC_INVALID_GEOMETRY_ID: c_uint = c_uint::MAX;

/// `RTCRay`, then `RTCHit` with room for further fields of other versions at its end.
#[repr(C, align(16))]
struct RayHit {
    origin: [f32; 3],
    near: f32,
    direction: [f32; 3],
    time: f32,
    far: f32,
    mask: c_uint,
    id: c_uint,
    flags: c_uint,
    normal: [f32; 3],
    parameters: [f32; 2],
    primitive: c_uint,
    geometry: c_uint,
    instances: [c_uint; 8],
}

const _: () = assert!(offset_of!(RayHit, normal) == 48 && offset_of!(RayHit, geometry) == 72);

impl RayHit {
    #[inline]
    fn new(ray: &Ray) -> Self {
        Self {
            origin: ray.origin.to_array(),
            near: 0.0,
            direction: ray.direction.to_array(),
            time: 0.0,
            far: ray.t_max,
            mask: c_uint::MAX,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            parameters: [0.0; 2],
            primitive: RTC_INVALID_GEOMETRY_ID,
            geometry: RTC_INVALID_GEOMETRY_ID,
            instances: [RTC_INVALID_GEOMETRY_ID; 8],
        }
    }
}

/// Declares the functions that are looked up, and looks them up.
macro_rules! functions {
    ($($name:ident: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        #[expect(non_snake_case, reason = "the names of the library")]
        #[derive(Debug)]
        struct Functions { $($name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)* }

        impl Functions {
            fn of(library: &Library) -> Result<Self, libloading::Error> {
                // SAFETY: each has the type that the headers of Embree 4 give the function of that name.
                unsafe { Ok(Self { $($name: *library.get(concat!(stringify!($name), "\0").as_bytes())?,)* }) }
            }
        }
    };
}

functions! {
    rtcNewDevice: fn(*const c_char) -> Handle;
    rtcReleaseDevice: fn(Handle);
    rtcGetDeviceError: fn(Handle) -> c_int;
    rtcSetDeviceMemoryMonitorFunction: fn(Handle, Monitor, Handle);
    rtcNewScene: fn(Handle) -> Handle;
    rtcSetSceneFlags: fn(Handle, c_int);
    rtcCommitScene: fn(Handle);
    rtcReleaseScene: fn(Handle);
    rtcNewGeometry: fn(Handle, c_int) -> Handle;
    rtcSetSharedGeometryBuffer: fn(Handle, c_int, c_uint, c_int, *const c_void, usize, usize, usize);
    rtcSetGeometryInstancedScene: fn(Handle, Handle);
    rtcSetGeometryTransform: fn(Handle, c_uint, c_int, *const c_void);
    rtcCommitGeometry: fn(Handle);
    rtcAttachGeometry: fn(Handle, Handle) -> c_uint;
    rtcReleaseGeometry: fn(Handle);
    rtcIntersect1: fn(Handle, *mut RayHit, *const c_void);
    rtcOccluded1: fn(Handle, *mut RayHit, *const c_void);
}

/// Bytes that the devices of this process hold.
static BYTES: AtomicI64 = AtomicI64::new(0);

extern "C" fn count(_: Handle, bytes: isize, _: bool) -> bool {
    BYTES.fetch_add(bytes as i64, Ordering::Relaxed);
    true
}

/// The library, with a device.
#[derive(Debug)]
pub struct Device {
    functions: Functions,
    device: Handle,
    /// Unloaded last.
    _library: Library,
}

/// Where Embree may be: what `ETALON_EMBREE` names, the system's, or that of PyPI's `embreex` in `target/venv`.
fn places(workspace: &Path) -> Vec<OsString> {
    if let Some(named) = env::var_os("ETALON_EMBREE") {
        return vec![named];
    }
    let folders = |folder: PathBuf| fs::read_dir(folder).into_iter().flatten().flatten();
    let pythons = folders(workspace.join("target/venv/lib"));
    let wheels =
        pythons.flat_map(|python| folders(python.path().join("site-packages/embreex.libs")));
    let is_embree = |path: &PathBuf| {
        let name = path
            .file_name()
            .map(|name| name.to_string_lossy().into_owned());
        name.is_some_and(|name| name.starts_with("libembree4"))
    };
    let found = wheels.map(|file| file.path()).filter(is_embree);
    let system = ["libembree4.so.4", "libembree4.dylib", "embree4.dll"];
    (system.map(OsString::from).into_iter())
        .chain(found.map(PathBuf::into_os_string))
        .collect()
}

/// What the system says, rather than which of its functions failed.
fn reason(error: &libloading::Error) -> String {
    error
        .source()
        .map_or_else(|| error.to_string(), |source| source.to_string())
}

impl Device {
    /// Embree on so many threads, if it is found; otherwise why not. `workspace` is the folder that has `target`.
    pub fn find(workspace: &Path, threads: usize) -> Result<Self, String> {
        let mut why = String::from("Embree's library was not found");
        for place in places(workspace) {
            match Self::load(&place, threads) {
                Ok(device) => return Ok(device),
                Err(message) => why = message,
            }
        }
        Err(why)
    }

    fn load(place: &OsString, threads: usize) -> Result<Self, String> {
        // SAFETY: what the user or the system calls Embree is run as such.
        let library = unsafe { Library::new(place) }.map_err(|e| reason(&e))?;
        let functions = Functions::of(&library).map_err(|e| reason(&e))?;
        let configuration = CString::new(format!("isa=avx2,threads={threads}"));
        let configuration = configuration.expect("without a zero");
        // SAFETY: the configuration is a string with its zero, the monitor lives as long as the program.
        let device = unsafe {
            let device = (functions.rtcNewDevice)(configuration.as_ptr());
            if !device.is_null() {
                (functions.rtcSetDeviceMemoryMonitorFunction)(device, count, ptr::null_mut());
            }
            device
        };
        if device.is_null() {
            return Err("Embree has no device with AVX2 here".to_owned());
        }
        Ok(Self {
            functions,
            device,
            _library: library,
        })
    }

    /// What went wrong since this was asked last.
    fn check(&self) {
        // SAFETY: the device is alive.
        let error = unsafe { (self.functions.rtcGetDeviceError)(self.device) };
        assert_eq!(error, 0, "Embree's error code");
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: scenes borrow the device, so that none of them is left.
        unsafe { (self.functions.rtcReleaseDevice)(self.device) }
    }
}

/// The numbers that Embree reads where they are.
#[derive(Debug)]
enum Buffer {
    /// With one corner more than there are: Embree reads sixteen bytes of each.
    Mesh(Vec<[f32; 3]>, Vec<[u32; 3]>),
    Balls(Vec<[f32; 4]>),
}

/// A scene described to Embree; [`Prepared::build`] builds its trees.
#[derive(Debug)]
pub struct Prepared<'a> {
    device: &'a Device,
    scene: Handle,
    /// Scenes that instances place; committed before the scene is.
    parts: Vec<Handle>,
    buffers: Vec<Buffer>,
    before: i64,
}

impl<'a> Prepared<'a> {
    /// Describes a scene.
    pub fn new(device: &'a Device, scene: &Scene) -> Self {
        let mut prepared = Self {
            device,
            scene: ptr::null_mut(),
            parts: Vec::new(),
            buffers: Vec::new(),
            before: BYTES.load(Ordering::Relaxed),
        };
        prepared.scene = prepared.new_scene();
        for object in &scene.objects {
            match object {
                Object::Mesh(mesh) => prepared.add_mesh(prepared.scene, mesh),
                Object::Balls(balls) => {
                    let balls = balls.iter().map(|(at, radius)| [at.x, at.y, at.z, *radius]);
                    let balls = Buffer::Balls(balls.collect());
                    prepared.add(prepared.scene, RTC_GEOMETRY_TYPE_SPHERE_POINT, balls);
                }
                Object::Instances(mesh, placements) => {
                    let part = prepared.new_scene();
                    prepared.add_mesh(part, mesh);
                    prepared.parts.push(part);
                    for placement in placements {
                        prepared.place(part, placement);
                    }
                }
            }
        }
        device.check();
        prepared
    }

    fn new_scene(&self) -> Handle {
        let Device {
            functions, device, ..
        } = self.device;
        // SAFETY: the device is alive.
        unsafe {
            let scene = (functions.rtcNewScene)(*device);
            (functions.rtcSetSceneFlags)(scene, RTC_SCENE_FLAG_ROBUST);
            scene
        }
    }

    fn add_mesh(&mut self, scene: Handle, mesh: &MeshData) {
        let corners = mesh.positions.iter().map(|p| p.to_array());
        let corners = corners.chain([[0.0; 3]]).collect();
        let buffer = Buffer::Mesh(corners, mesh.triangles.clone());
        self.add(scene, RTC_GEOMETRY_TYPE_TRIANGLE, buffer);
    }

    fn add(&mut self, scene: Handle, kind: c_int, buffer: Buffer) {
        let functions = &self.device.functions;
        // SAFETY: the buffers are as long as is said, and live as long as the scene; moving `Buffer` does not move what
        // its vectors hold.
        unsafe {
            let geometry = (functions.rtcNewGeometry)(self.device.device, kind);
            let share =
                |of: c_int, format: c_int, at: *const c_void, stride: usize, count: usize| {
                    (functions.rtcSetSharedGeometryBuffer)(
                        geometry, of, 0, format, at, 0, stride, count,
                    );
                };
            match &buffer {
                Buffer::Mesh(corners, triangles) => {
                    let (at, count) = (corners.as_ptr().cast(), corners.len() - 1);
                    share(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, at, 12, count);
                    let (at, count) = (triangles.as_ptr().cast(), triangles.len());
                    share(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, at, 12, count);
                }
                Buffer::Balls(balls) => {
                    let (at, count) = (balls.as_ptr().cast(), balls.len());
                    share(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, at, 16, count);
                }
            }
            self.attach(scene, geometry);
        }
        self.buffers.push(buffer);
    }

    fn place(&self, part: Handle, placement: &Mat4) {
        let functions = &self.device.functions;
        let matrix = placement.to_cols_array();
        let format = RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR;
        // SAFETY: the matrix has sixteen numbers, and is copied.
        unsafe {
            let geometry =
                (functions.rtcNewGeometry)(self.device.device, RTC_GEOMETRY_TYPE_INSTANCE);
            (functions.rtcSetGeometryInstancedScene)(geometry, part);
            (functions.rtcSetGeometryTransform)(geometry, 0, format, matrix.as_ptr().cast());
            self.attach(self.scene, geometry);
        }
    }

    /// # Safety
    ///
    /// Both belong to the device.
    unsafe fn attach(&self, scene: Handle, geometry: Handle) {
        let functions = &self.device.functions;
        // SAFETY: the scene keeps the geometry.
        unsafe {
            (functions.rtcCommitGeometry)(geometry);
            (functions.rtcAttachGeometry)(scene, geometry);
            (functions.rtcReleaseGeometry)(geometry);
        }
    }

    /// Builds the trees: what is timed as Embree's build.
    pub fn build(self) -> Embree<'a> {
        for part in self.parts.iter().chain([&self.scene]) {
            // SAFETY: the scene is alive.
            unsafe { (self.device.functions.rtcCommitScene)(*part) }
        }
        self.device.check();
        Embree {
            bytes: (BYTES.load(Ordering::Relaxed) - self.before).max(0) as usize,
            scene: self,
        }
    }
}

impl Drop for Prepared<'_> {
    fn drop(&mut self) {
        for part in self.parts.iter().chain([&self.scene]) {
            // SAFETY: this was the only holder of the scene except for scenes that place it.
            unsafe { (self.device.functions.rtcReleaseScene)(*part) }
        }
    }
}

/// A scene in Embree's trees.
#[derive(Debug)]
pub struct Embree<'a> {
    scene: Prepared<'a>,
    /// Memory of the trees, which hold copies of all triangles' corners (bytes).
    pub bytes: usize,
}

// SAFETY: a committed scene is only read by the two functions that are called on it, which Embree allows on any number
// of threads.
unsafe impl Sync for Embree<'_> {}

impl Embree<'_> {
    /// The distance of the nearest hit; infinite without one.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> f32 {
        let mut hit = RayHit::new(ray);
        let Prepared { device, scene, .. } = &self.scene;
        // SAFETY: the scene is committed; null arguments are the default ones.
        unsafe { (device.functions.rtcIntersect1)(*scene, &raw mut hit, ptr::null()) };
        match hit.geometry {
            RTC_INVALID_GEOMETRY_ID => f32::INFINITY,
            _ => hit.far,
        }
    }

    /// Whether anything is hit.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        let mut hit = RayHit::new(ray);
        let Prepared { device, scene, .. } = &self.scene;
        // SAFETY: as above; of the structure only the ray is used.
        unsafe { (device.functions.rtcOccluded1)(*scene, &raw mut hit, ptr::null()) };
        hit.far == f32::NEG_INFINITY
    }
}
