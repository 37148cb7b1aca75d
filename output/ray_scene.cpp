// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <utility>

namespace tranos::output {
namespace {

// Embree's handles, released with their owner.
template <class Handle, void (*release)(Handle)>
struct Owned {
  Handle handle = nullptr;
  explicit Owned(Handle h) : handle(h) {}
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() {
    if (handle) release(handle);
  }
};
using Device = Owned<RTCDevice, rtcReleaseDevice>;
using Tree = Owned<RTCScene, rtcReleaseScene>;
using Shape = Owned<RTCGeometry, rtcReleaseGeometry>;

constexpr std::uint32_t kNone = RTC_INVALID_GEOMETRY_ID;

// The surface's index is the instance's, or the geometry's where there is no instance.
std::uint32_t SurfaceOf(std::uint32_t instance, std::uint32_t geometry) {
  return instance != kNone ? instance : geometry;
}

// The tracer's context, extended by what each ray has met last.
struct Context {
  RTCIntersectContext base;
  std::array<std::uint32_t, kPacket> surface, triangle;
  std::array<float, kPacket> depth;
};

// Among hits at one depth the lowest (surface, triangle) counts, whatever order the tree is walked
// in.
void BreakTies(const RTCFilterFunctionNArguments* arguments) {
  auto* context = reinterpret_cast<Context*>(arguments->context);
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (!arguments->valid[i]) continue;
    const unsigned lane = RTCRayN_id(arguments->ray, arguments->N, i);
    const float depth = RTCRayN_tfar(arguments->ray, arguments->N, i);
    const std::uint32_t surface = SurfaceOf(RTCHitN_instID(arguments->hit, arguments->N, i, 0),
                                            RTCHitN_geomID(arguments->hit, arguments->N, i));
    const std::uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
    if (depth == context->depth[lane] &&
        std::pair(context->surface[lane], context->triangle[lane]) < std::pair(surface, triangle)) {
      arguments->valid[i] = 0;
      continue;
    }
    context->depth[lane] = depth;
    context->surface[lane] = surface;
    context->triangle[lane] = triangle;
  }
}

void AttachTriangles(RTCDevice device, RTCScene scene, const RaySurface& surface,
                     const Eigen::Matrix<float, 3, 4>& transform, std::uint32_t index) {
  const RayMesh& mesh = *surface.mesh;
  const Shape shape(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* positions = static_cast<float*>(
      rtcSetNewGeometryBuffer(shape.handle, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              3 * sizeof(float), mesh.positions.size()));
  auto* triangles = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(shape.handle, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.triangles.size()));
  if (!positions || !triangles) return;  // the device keeps the error
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    Eigen::Map<Eigen::Vector3f>(positions + 3 * i) =
        transform.leftCols<3>() * Eigen::Map<const Eigen::Vector3f>(mesh.positions[i].data()) +
        transform.col(3);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) triangles[3 * i + k] = mesh.triangles[i][k];
  }
  rtcSetGeometryIntersectFilterFunction(shape.handle, BreakTies);
  rtcCommitGeometry(shape.handle);
  rtcAttachGeometryByID(scene, shape.handle, index);
}

void AttachInstance(RTCDevice device, RTCScene scene, RTCScene part, const RaySurface& surface,
                    std::uint32_t index) {
  const Shape shape(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(shape.handle, part);
  rtcSetGeometryTransform(shape.handle, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                          surface.picture_from_mesh.data());
  rtcCommitGeometry(shape.handle);
  rtcAttachGeometryByID(scene, shape.handle, index);
}

RayPacket Filled(const Eigen::Vector3f& v) {
  RayPacket packet;
  packet.x.fill(v.x());
  packet.y.fill(v.y());
  packet.z.fill(v.z());
  return packet;
}

void FillRays(const RayPacket& rays, const RayPacket& directions, RTCRay16& query) {
  for (unsigned i = 0; i < kPacket; ++i) {
    query.org_x[i] = rays.x[i];
    query.org_y[i] = rays.y[i];
    query.org_z[i] = rays.z[i];
    query.dir_x[i] = directions.x[i];
    query.dir_y[i] = directions.y[i];
    query.dir_z[i] = directions.z[i];
    query.tnear[i] = 0;
    query.tfar[i] = std::numeric_limits<float>::infinity();
    query.time[i] = 0;
    query.mask[i] = 0xffffffff;
    query.id[i] = i;
    query.flags[i] = 0;
  }
}

RTCScene NewTree(RTCDevice device) {
  const RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  return scene;
}

}  // namespace

// The device first: members are released in reverse.
struct RayScene::Trees {
  Trees() : device(rtcNewDevice("threads=1,set_affinity=0")), world(NewTree(device.handle)) {}
  Device device;
  std::vector<std::unique_ptr<Tree>> parts;  // a tree for each mesh that is shown more than once
  Tree world;
};

Result<RayScene> RayScene::Of(const std::vector<RaySurface>& surfaces) {
  const auto trees = std::make_shared<Trees>();
  const RTCDevice device = trees->device.handle;
  std::unordered_map<const RayMesh*, std::size_t> uses;
  for (const RaySurface& surface : surfaces) ++uses[surface.mesh.get()];
  std::unordered_map<const RayMesh*, RTCScene> part_of_mesh;
  Eigen::Matrix<float, 3, 4> identity;
  identity.setIdentity();
  for (std::uint32_t i = 0; i < surfaces.size(); ++i) {
    const RaySurface& surface = surfaces[i];
    if (uses[surface.mesh.get()] == 1) {
      AttachTriangles(device, trees->world.handle, surface, surface.picture_from_mesh, i);
      continue;
    }
    RTCScene& part = part_of_mesh[surface.mesh.get()];
    if (!part) {
      part = NewTree(device);
      trees->parts.push_back(std::make_unique<Tree>(part));
      AttachTriangles(device, part, surface, identity, 0);
      rtcCommitScene(part);
    }
    AttachInstance(device, trees->world.handle, part, surface, i);
  }
  rtcCommitScene(trees->world.handle);
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
    return tl::unexpected(Error{"the picture needs more memory than there is"});
  }
  return RayScene(trees);
}

HitPacket RayScene::Meet(const RayPacket& rays, const RayPacket& directions) const {
  Context context;
  rtcInitIntersectContext(&context.base);
  context.depth.fill(-1);
  RTCRayHit16 query;
  FillRays(rays, directions, query.ray);
  alignas(64) std::array<int, kPacket> valid;
  valid.fill(-1);
  std::fill_n(query.hit.geomID, kPacket, kNone);
  std::fill_n(query.hit.instID[0], kPacket, kNone);
  // Without the flag for coherent rays: with it Embree 3.13 was seen to run for ever over
  // instances, and it gained nothing.
  rtcIntersect16(valid.data(), trees_->world.handle, &context.base, &query);
  HitPacket hits;
  for (unsigned i = 0; i < kPacket; ++i) {
    hits.surface[i] = query.hit.geomID[i] == kNone
                          ? kNothing
                          : SurfaceOf(query.hit.instID[0][i], query.hit.geomID[i]);
    hits.triangle[i] = query.hit.primID[i];
    hits.u[i] = query.hit.u[i];
    hits.v[i] = query.hit.v[i];
    hits.z[i] = query.ray.tfar[i];
  }
  return hits;
}

HitPacket RayScene::FirstHits(const RayPacket& rays) const {
  HitPacket hits = Meet(rays, Filled(-Eigen::Vector3f::UnitZ()));
  for (unsigned i = 0; i < kPacket; ++i) hits.z[i] = rays.z[i] - hits.z[i];
  return hits;
}

HitPacket RayScene::FirstHitsFrom(const Eigen::Vector3f& point, const RayPacket& directions) const {
  return Meet(Filled(point), directions);
}

void RayScene::DropOccluded(const RayPacket& rays, const RayPacket& directions,
                            LanePacket& lanes) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay16 query;
  FillRays(rays, directions, query);
  alignas(64) std::array<int, kPacket> valid;
  for (unsigned i = 0; i < kPacket; ++i) valid[i] = lanes[i] ? -1 : 0;
  rtcOccluded16(valid.data(), trees_->world.handle, &context, &query);
  for (unsigned i = 0; i < kPacket; ++i) lanes[i] = lanes[i] && query.tfar[i] >= 0;
}

bool RayScene::Occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray;
  ray.org_x = origin.x(), ray.org_y = origin.y(), ray.org_z = origin.z();
  ray.dir_x = direction.x(), ray.dir_y = direction.y(), ray.dir_z = direction.z();
  ray.tnear = 0, ray.tfar = std::numeric_limits<float>::infinity();
  ray.time = 0, ray.mask = 0xffffffff, ray.id = 0, ray.flags = 0;
  rtcOccluded1(trees_->world.handle, &context, &ray);
  return ray.tfar < 0;
}

}  // namespace tranos::output
