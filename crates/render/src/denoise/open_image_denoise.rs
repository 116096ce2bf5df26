//! Intel's Open Image Denoise as a filter, loaded at run time by its C interface
//! (<https://github.com/RenderKit/oidn>, `include/OpenImageDenoise/oidn.h`). Nothing is linked, and the library is optional.
//!
//! A network is given either half of the picture, with albedo and normal, so that the other half tells its error as that of any
//! filter. On the processor, whose results do not depend on a driver.

#![expect(unsafe_code, reason = "the interface of a C library")]

use super::regression::Filtered;
use super::{Halves, Plane};
use core::error::Error;
use core::ffi::{CStr, c_char, c_int, c_void};
use core::ptr;
use libloading::Library;
use std::ffi::OsString;
use std::path::Path;

type Handle = *mut c_void;

/// Constants of the header, by the names there.
const OIDN_DEVICE_TYPE_CPU: c_int = 1;
const OIDN_FORMAT_FLOAT3: c_int = 3;

/// Where the system may have it.
const NAMES: [&str; 5] = [
    "libOpenImageDenoise.so.2",
    "libOpenImageDenoise.so",
    "libOpenImageDenoise.2.dylib",
    "libOpenImageDenoise.dylib",
    "OpenImageDenoise.dll",
];

/// Declares the functions that are looked up, and looks them up.
macro_rules! functions {
    ($($name:ident: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        #[expect(non_snake_case, reason = "the names of the library")]
        #[derive(Debug)]
        struct Functions { $($name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)* }

        impl Functions {
            fn of(library: &Library) -> Result<Self, libloading::Error> {
                // SAFETY: each has the type that the header of version 2 gives the function of that name.
                unsafe { Ok(Self { $($name: *library.get(concat!(stringify!($name), "\0").as_bytes())?,)* }) }
            }
        }
    };
}

functions! {
    oidnNewDevice: fn(c_int) -> Handle;
    oidnCommitDevice: fn(Handle);
    oidnGetDeviceInt: fn(Handle, *const c_char) -> c_int;
    oidnGetDeviceError: fn(Handle, *mut *const c_char) -> c_int;
    oidnReleaseDevice: fn(Handle);
    oidnNewFilter: fn(Handle, *const c_char) -> Handle;
    oidnSetSharedFilterImage: fn(Handle, *const c_char, Handle, c_int, usize, usize, usize, usize, usize);
    oidnSetFilterBool: fn(Handle, *const c_char, bool);
    oidnCommitFilter: fn(Handle);
    oidnExecuteFilter: fn(Handle);
    oidnReleaseFilter: fn(Handle);
}

/// The library, with a device.
#[derive(Debug)]
pub struct OpenImageDenoise {
    functions: Functions,
    device: Handle,
    /// Unloaded last.
    _library: Library,
}

impl OpenImageDenoise {
    /// The library at `place`, a file or a folder, or the system's.
    ///
    /// # Errors
    /// Why there is none, in a sentence.
    pub fn find(place: Option<&Path>) -> Result<Self, String> {
        let places: Vec<OsString> = match place {
            Some(folder) if folder.is_dir() => {
                let files = NAMES.iter().map(|name| folder.join(name));
                files.map(|file| file.into_os_string()).collect()
            }
            Some(file) => vec![file.as_os_str().to_owned()],
            None => NAMES.iter().map(OsString::from).collect(),
        };
        let mut why = String::new();
        for place in &places {
            match Self::load(place) {
                Ok(library) => return Ok(library),
                // The first reason is that of the name that is usual.
                Err(reason) if why.is_empty() => why = reason,
                Err(_) => {}
            }
        }
        Err(format!("Open Image Denoise 2 cannot be loaded: {why}"))
    }

    fn load(place: &OsString) -> Result<Self, String> {
        let reason = |error: libloading::Error| {
            let source = error.source().map(ToString::to_string);
            source.unwrap_or_else(|| error.to_string())
        };
        // SAFETY: what the user or the system calls Open Image Denoise is run as such.
        let library = unsafe { Library::new(place) }.map_err(reason)?;
        let functions = Functions::of(&library).map_err(reason)?;
        // SAFETY: a device is asked for, and used if there is one.
        let device = unsafe { (functions.oidnNewDevice)(OIDN_DEVICE_TYPE_CPU) };
        if device.is_null() {
            return Err("it has no device for this processor".to_owned());
        }
        // SAFETY: the device is alive.
        unsafe { (functions.oidnCommitDevice)(device) };
        let found = Self {
            functions,
            device,
            _library: library,
        };
        found.check()?;
        Ok(found)
    }

    /// Its version, such as `2.5.1`.
    pub fn version(&self) -> String {
        // SAFETY: the device is alive, and the name ends in a zero.
        let number = unsafe { (self.functions.oidnGetDeviceInt)(self.device, c"version".as_ptr()) };
        let [major, minor, patch] = [number / 10_000, number / 100 % 100, number % 100];
        format!("{major}.{minor}.{patch}")
    }

    /// What went wrong since this was asked last.
    fn check(&self) -> Result<(), String> {
        let mut message: *const c_char = ptr::null();
        // SAFETY: the device is alive; the message is a string of the library's, copied before it is called again.
        let (code, message) = unsafe {
            let code = (self.functions.oidnGetDeviceError)(self.device, &raw mut message);
            let known = !message.is_null();
            (
                code,
                known.then(|| CStr::from_ptr(message).to_string_lossy().into_owned()),
            )
        };
        match code {
            0 => Ok(()),
            code => Err(message.unwrap_or_else(|| format!("error {code}"))),
        }
    }

    /// What the network makes of either half.
    pub(super) fn filter(&self, halves: &Halves) -> Result<Filtered, String> {
        let plane = |first: usize| -> Plane {
            let pixels = halves.features.iter();
            pixels
                .map(|f| [f[first], f[first + 1], f[first + 2]])
                .collect()
        };
        let (albedo, normal) = (plane(0), plane(3));
        let [a, b] = &halves.halves;
        let denoise = |half: &Plane| self.one(halves, half, [&albedo, &normal]);
        Ok([denoise(a)?, denoise(b)?])
    }

    fn one(
        &self,
        halves: &Halves,
        half: &Plane,
        [albedo, normal]: [&Plane; 2],
    ) -> Result<Plane, String> {
        // A picture of luminance is shown to it in grey.
        let grey = |pixel: &[f32; 3]| [pixel[0]; 3];
        let colour: Plane = match halves.colours.len() {
            1 => half.iter().map(grey).collect(),
            _ => half.clone(),
        };
        let mut output = vec![[0.0_f32; 3]; half.len()];
        let f = &self.functions;
        // SAFETY: the device is alive; names end in zeros; all images have as many pixels as is said, and live until the
        // filter, which only writes to the output, is released.
        unsafe {
            let filter = (f.oidnNewFilter)(self.device, c"RT".as_ptr());
            let images = [
                (c"color", colour.as_ptr().cast_mut()),
                (c"albedo", albedo.as_ptr().cast_mut()),
                (c"normal", normal.as_ptr().cast_mut()),
                (c"output", output.as_mut_ptr()),
            ];
            let [width, height] = halves.size;
            for (name, pixels) in images {
                let (name, pixels) = (name.as_ptr(), pixels.cast());
                (f.oidnSetSharedFilterImage)(
                    filter,
                    name,
                    pixels,
                    OIDN_FORMAT_FLOAT3,
                    width,
                    height,
                    0,
                    0,
                    0,
                );
            }
            (f.oidnSetFilterBool)(filter, c"hdr".as_ptr(), true);
            (f.oidnCommitFilter)(filter);
            (f.oidnExecuteFilter)(filter);
            (f.oidnReleaseFilter)(filter);
        }
        self.check()?;
        Ok(output)
    }
}

impl Drop for OpenImageDenoise {
    fn drop(&mut self) {
        // SAFETY: no filter is left.
        unsafe { (self.functions.oidnReleaseDevice)(self.device) }
    }
}
