//! As much of Embree 4's interface as a comparison needs, loaded at run time.
#![allow(unsafe_code)]

use crate::scenes::Query;
use glam::Vec3;
use libloading::Library;
use radianza::math::Ray;
use std::ffi::{OsStr, c_char, c_int, c_uint, c_void};
use std::ptr::{null, null_mut};

/// How well a tree is built.
#[derive(Clone, Copy, Debug)]
pub(crate) enum BuildQuality {
    Medium = 1,
    High = 2,
}

const GEOMETRY_TYPE_TRIANGLE: c_uint = 0;
const BUFFER_TYPE_INDEX: c_uint = 0;
const BUFFER_TYPE_VERTEX: c_uint = 1;
const FORMAT_UINT3: c_uint = 0x5003;
const FORMAT_FLOAT3: c_uint = 0x9003;
const SCENE_FLAG_ROBUST: c_uint = 1 << 2;
const INVALID: u32 = u32::MAX;

type Handle = *mut c_void;

/// `RTCRay`: origin and near end; direction and time; far end, mask, id, flags.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
struct PlainRay {
    origin: [f32; 4],
    direction: [f32; 4],
    far: [u32; 4],
}

/// `RTCRayHit`: the ray, then the hit, to which later versions add.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
struct RayHit {
    ray: PlainRay,
    normal_u: [f32; 4],
    v_ids: [u32; 4],
    more: [u32; 4],
}

type Intersect = unsafe extern "C" fn(Handle, *mut RayHit, *const c_void);
type Occluded = unsafe extern "C" fn(Handle, *mut PlainRay, *const c_void);

/// The library and a device of one thread.
pub(crate) struct Embree {
    functions: Library,
    device: Handle,
    intersect: Intersect,
    occluded: Occluded,
}

/// A committed scene.
pub(crate) struct Tree<'a> {
    embree: &'a Embree,
    scene: Handle,
    // Embree reads past the last vertex: kept as long as the scene.
    _vertices: Vec<[f32; 4]>,
    _indices: Vec<[u32; 3]>,
}

impl Embree {
    pub(crate) fn load(path: &OsStr) -> Result<Self, libloading::Error> {
        // SAFETY: the user names a library that is Embree 4; its signatures are those of embree4/rtcore.h.
        unsafe {
            let library = Library::new(path)?;
            let new_device = library.get::<unsafe extern "C" fn(*const c_char) -> Handle>(b"rtcNewDevice\0")?;
            let device = new_device(null());
            let intersect = *library.get::<Intersect>(b"rtcIntersect1\0")?;
            let occluded = *library.get::<Occluded>(b"rtcOccluded1\0")?;
            Ok(Self { functions: library, device, intersect, occluded })
        }
    }

    pub(crate) fn build(
        &self,
        positions: &[Vec3],
        indices: &[[u32; 3]],
        quality: BuildQuality,
        robust: bool,
    ) -> Tree<'_> {
        let vertices: Vec<[f32; 4]> = positions.iter().map(|p| [p.x, p.y, p.z, 0.0]).collect();
        let indices = indices.to_vec();
        let get = |name: &[u8]| -> Handle {
            // SAFETY: the pointer is only turned into the function that the header declares.
            let symbol = unsafe { self.functions.get::<Handle>(name) };
            *symbol.unwrap_or_else(|e| panic!("no Embree 4: {e}"))
        };
        macro_rules! call {
            ($name:literal($($argument:expr),*): $type:ty) => {{
                // SAFETY: signature and arguments are those of embree4/rtcore.h; buffers outlive the scene.
                let function: $type = unsafe { std::mem::transmute::<Handle, $type>(get($name)) };
                unsafe { function($($argument),*) }
            }};
        }
        type One = unsafe extern "C" fn(Handle);
        type Made = unsafe extern "C" fn(Handle) -> Handle;
        type Set = unsafe extern "C" fn(Handle, c_uint);
        type Attach = unsafe extern "C" fn(Handle, Handle) -> c_uint;
        type New = unsafe extern "C" fn(Handle, c_uint) -> Handle;
        type Share = unsafe extern "C" fn(Handle, c_uint, c_uint, c_uint, *const c_void, usize, usize, usize);
        let scene = call!(b"rtcNewScene\0"(self.device): Made);
        call!(b"rtcSetSceneBuildQuality\0"(scene, quality as c_uint): Set);
        call!(b"rtcSetSceneFlags\0"(scene, if robust { SCENE_FLAG_ROBUST } else { 0 }): Set);
        let geometry = call!(b"rtcNewGeometry\0"(self.device, GEOMETRY_TYPE_TRIANGLE): New);
        call!(b"rtcSetGeometryBuildQuality\0"(geometry, quality as c_uint): Set);
        let (v, i) = (vertices.as_ptr().cast(), indices.as_ptr().cast());
        call!(b"rtcSetSharedGeometryBuffer\0"(geometry, BUFFER_TYPE_VERTEX, 0, FORMAT_FLOAT3, v, 0, 16, vertices.len()): Share);
        call!(b"rtcSetSharedGeometryBuffer\0"(geometry, BUFFER_TYPE_INDEX, 0, FORMAT_UINT3, i, 0, 12, indices.len()): Share);
        call!(b"rtcCommitGeometry\0"(geometry): One);
        call!(b"rtcAttachGeometry\0"(scene, geometry): Attach);
        call!(b"rtcReleaseGeometry\0"(geometry): One);
        call!(b"rtcCommitScene\0"(scene): One);
        let error = call!(b"rtcGetDeviceError\0"(self.device): unsafe extern "C" fn(Handle) -> c_int);
        assert_eq!(error, 0, "Embree reports an error");
        Tree { embree: self, scene, _vertices: vertices, _indices: indices }
    }
}

impl Tree<'_> {
    /// Number of rays that meet something, and Σ t of nearest hits, where nothing counts nearer than `near` times the largest
    /// coordinate of a ray's origin.
    pub(crate) fn answer(&self, query: Query, rays: &[Ray], near: f32) -> (usize, f64) {
        let Embree { intersect, occluded, .. } = *self.embree;
        let (mut met, mut sum) = (0, 0.0);
        for ray in rays {
            let near = near * ray.o.abs().max_element();
            let (origin, direction) = (ray.o.extend(near).to_array(), ray.d.extend(0.0).to_array());
            let far = [ray.t_max.to_bits(), u32::MAX, 0, 0];
            let mut ray = PlainRay { origin, direction, far };
            match query {
                Query::Nearest => {
                    let v_ids = [0, INVALID, INVALID, INVALID];
                    let mut r = RayHit { ray, normal_u: [0.0; 4], v_ids, more: [INVALID; 4] };
                    // SAFETY: the scene is committed, and the ray laid out and aligned as the header says.
                    unsafe { intersect(self.scene, &raw mut r, null()) };
                    if r.v_ids[2] != INVALID {
                        met += 1;
                        sum += f64::from(f32::from_bits(r.ray.far[0]));
                    }
                }
                Query::Occluded => {
                    // SAFETY: as above.
                    unsafe { occluded(self.scene, &raw mut ray, null()) };
                    met += usize::from(f32::from_bits(ray.far[0]) < 0.0);
                }
            }
        }
        (met, sum)
    }
}

impl Drop for Tree<'_> {
    fn drop(&mut self) {
        // SAFETY: the scene is released once, before its library.
        unsafe {
            if let Ok(release) = self.embree.functions.get::<unsafe extern "C" fn(Handle)>(b"rtcReleaseScene\0") {
                release(self.scene);
            }
        }
        self.scene = null_mut();
    }
}
