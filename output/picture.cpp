// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/picture.h"

#include <algorithm>
#include <new>
#include <optional>
#include <string>

#include "output/parallel.h"
#include "output/shading.h"
#include "output/stroke_raster.h"

namespace tranos::output {
namespace {

constexpr int kBlock = 4;  // a packet is a square of samples
static_assert(kBlock * kBlock == kPacket);

// Everything that a tile is made from.
struct Ingredients {
  const Scene& scene;
  const InkIndex& ink;
  const RayScene* rays;  // null: surfaces are not seen
  const Shader* shader;
};

Shade GroundOfRow(const Ingredients& ingredients, int row_px) {
  if (!ingredients.shader) return Shade::Ones();
  return GroundAt((static_cast<float>(row_px) + 0.5f) /
                  static_cast<float>(ingredients.scene.camera.height_px));
}

void FillGround(const Ingredients& ingredients, Tile& tile) {
  for (int y = 0; y < tile.side(); ++y) {
    const Shade ground = GroundOfRow(ingredients, tile.top_px + y / tile.per_pixel);
    const std::size_t first = static_cast<std::size_t>(y) * tile.side();
    std::fill_n(tile.samples.begin() + static_cast<std::ptrdiff_t>(first), tile.side(), ground);
  }
  const Scene& scene = ingredients.scene;
  if (!scene.backdrop) return;
  for (int y = 0; y < tile.side(); ++y) {
    for (int x = 0; x < tile.side(); ++x) {
      const double across = tile.left_px + (x + 0.5) / tile.per_pixel - 0.5 * scene.camera.width_px;
      const double up = 0.5 * scene.camera.height_px - tile.top_px - (y + 0.5) / tile.per_pixel;
      const geom::Vec2 dot = scene.eye->DotAt(across, up);
      if (const auto shade = Sample(*scene.backdrop, dot.x(), dot.y())) {
        tile.samples[static_cast<std::size_t>(y) * tile.side() + x] = *shade;
      }
    }
  }
}

void ShadeBlock(const Ingredients& ingredients, Tile& tile, int left, int top) {
  const Camera& camera = ingredients.scene.camera;
  const float sample_px = 1.0f / static_cast<float>(tile.per_pixel);
  const float x0 = static_cast<float>(tile.left_px) - 0.5f * static_cast<float>(camera.width_px);
  const float y0 = 0.5f * static_cast<float>(camera.height_px) - static_cast<float>(tile.top_px);
  RayPacket packet;
  packet.z.fill(ingredients.scene.nearest + 10);
  for (int i = 0; i < kPacket; ++i) {
    packet.x[i] = x0 + sample_px * (static_cast<float>(left + i % kBlock) + 0.5f);
    packet.y[i] = y0 - sample_px * (static_cast<float>(top + i / kBlock) + 0.5f);
  }
  const HitPacket hits = ingredients.rays->FirstHits(packet);
  if (std::all_of(hits.surface.begin(), hits.surface.end(),
                  [](std::uint32_t surface) { return surface == kNothing; })) {
    return;
  }
  const auto sample = [&](int i) -> Shade& {
    return tile
        .samples[static_cast<std::size_t>(top + i / kBlock) * tile.side() + left + i % kBlock];
  };
  ShadePacket shades;
  for (int i = 0; i < kPacket; ++i) shades[i] = sample(i);
  ingredients.shader->Apply(packet, hits, shades);
  for (int i = 0; i < kPacket; ++i) sample(i) = shades[i];
}

std::uint8_t Quantized(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

// Each pixel is the mean of its samples.
void Resolve(const Tile& tile, Picture& picture) {
  const int n = tile.per_pixel;
  const float share = 1.0f / static_cast<float>(n * n);
  const int right = std::min(kTile_px, picture.width_px - tile.left_px);
  const int bottom = std::min(kTile_px, picture.height_px - tile.top_px);
  for (int y = 0; y < bottom; ++y) {
    for (int x = 0; x < right; ++x) {
      Shade sum = Shade::Zero();
      for (int k = 0; k < n * n; ++k) {
        const std::size_t row = static_cast<std::size_t>(y * n + k / n) * tile.side();
        sum += tile.samples[row + x * n + k % n].cwiseMin(1.0f);
      }
      const std::size_t pixel = static_cast<std::size_t>(tile.top_px + y) * picture.width_px +
                                static_cast<std::size_t>(tile.left_px + x);
      for (std::size_t c = 0; c < 3; ++c) {
        picture.rgb[3 * pixel + c] = Quantized(share * sum[static_cast<Eigen::Index>(c)]);
      }
    }
  }
}

void DrawTile(const Ingredients& ingredients, Tile& tile, Picture& picture) {
  tile.samples.resize(static_cast<std::size_t>(tile.side()) * tile.side());
  FillGround(ingredients, tile);
  if (ingredients.shader) {
    for (int y = 0; y < tile.side(); y += kBlock) {
      for (int x = 0; x < tile.side(); x += kBlock) ShadeBlock(ingredients, tile, x, y);
    }
  }
  ingredients.ink.Draw(tile);
  Resolve(tile, picture);
}

Picture DrawTiles(const Ingredients& ingredients, int per_pixel, int threads) {
  const Camera& camera = ingredients.scene.camera;
  Picture picture{camera.width_px, camera.height_px, {}};
  picture.rgb.resize(std::size_t{3} * camera.width_px * camera.height_px);
  const int columns = (camera.width_px + kTile_px - 1) / kTile_px;
  const int rows = (camera.height_px + kTile_px - 1) / kTile_px;
  ParallelFor(static_cast<std::size_t>(columns) * rows, threads, [&](std::size_t i) {
    Tile tile;
    tile.left_px = static_cast<int>(i % columns) * kTile_px;
    tile.top_px = static_cast<int>(i / columns) * kTile_px;
    tile.per_pixel = per_pixel;
    DrawTile(ingredients, tile, picture);
  });
  return picture;
}

}  // namespace

Result<Picture> Render(const model::RenderRequest& request, int threads) {
  const int width_px = request.width_px, height_px = request.height_px;
  if (std::min(width_px, height_px) < 1 || std::max(width_px, height_px) > kMaxSide_px) {
    return tl::unexpected(
        Error{"a picture has 1 to " + std::to_string(kMaxSide_px) + " pixels on each side"});
  }
  const Result<Scene> scene = SceneOf(request, threads);
  if (!scene) return tl::unexpected(scene.error());
  std::optional<RayScene> rays;
  if (request.view.mode != model::RenderMode::kWireframe && !scene->surfaces.empty()) {
    Result<RayScene> traced = RayScene::Of(scene->surfaces);
    if (!traced) return tl::unexpected(traced.error());
    rays = *std::move(traced);
  }
  const RayScene* ray_scene = rays ? &*rays : nullptr;
  const std::vector<InkLine> ink = InkOf(*scene, ray_scene, threads);
  const InkIndex ink_index(ink, width_px, height_px);
  std::optional<Shader> shader;
  if (request.view.mode == model::RenderMode::kPhong && rays) {
    shader.emplace(*scene, *rays, request.view.shadows);
  }
  const Ingredients ingredients{*scene, ink_index, ray_scene, shader ? &*shader : nullptr};
  return DrawTiles(ingredients, request.view.antialias ? 4 : 1, threads);
}

}  // namespace tranos::output
