// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/element_geometry.h"

#include "model/solid_hash.h"

namespace tranos::session {

namespace {

using geom::Vec3;

void Points(std::string_view key, const std::vector<Vec3>& points, JsonText* out) {
  out->Key(key).Open('[');
  for (const Vec3& point : points) out->Point(point);
  out->Close(']');
}
void Ratios(std::string_view key, const std::vector<double>& numbers, JsonText* out) {
  if (numbers.empty()) return;
  out->Key(key).Open('[');
  for (const double number : numbers) out->Ratio(number);
  out->Close(']');
}
void Frame(const geom::Frame& frame, JsonText* out) {
  out->Key("origin").Point(frame.origin).Key("x").Direction(frame.x).Key("y").Direction(frame.y);
}

// The members of an object, without its braces.
class GeometryWriter {
 public:
  GeometryWriter(KnownPrototypes* known, JsonText* out) : known_(known), out_(out) {}

  void operator()(const model::Point& point) { out_->Key("at").Point(point.position); }
  void operator()(const model::CurvePtr& curve) { std::visit(*this, *curve); }
  void operator()(const model::SurfacePtr& surface) { std::visit(*this, *surface); }
  // A solid is made in as many steps as the journal has told: what it is now is its hash.
  void operator()(const model::SolidPtr& solid) {
    out_->Key("content").String(model::Hex(model::HashOf(*solid)));
  }
  void operator()(const model::RegionPtr& region) {
    Frame(region->plane, out_);
    out_->Key("parts").Open('[');
    for (const geom::Region::Part& part : region->parts) {
      out_->Open('{').Key("outer");
      Outline(part.outer);
      out_->Key("holes").Open('[');
      for (const geom::Curve& hole : part.holes) Outline(hole);
      out_->Close(']').Close('}');
    }
    out_->Close(']');
  }
  void operator()(const model::TextPtr& text) {
    out_->Key("text").String(text->content).Key("height").Length(text->height_m);
    Frame(text->frame, out_);
  }
  void operator()(const model::GroupPtr& group) {
    out_->Key("members").Open('[');
    for (const model::ElementPtr& member : group->members) WriteElement(*member, known_, out_);
    out_->Close(']');
  }
  void operator()(const model::InstancePtr& instance) { Write(*instance); }
  void operator()(const model::PhotographPtr& photograph) {
    const auto& [size_mm, size_px] = photograph->frame;
    out_->Key("file").String(photograph->file);
    out_->Key("content").String(model::Hex(photograph->content));
    out_->Key("size_px").Open('[').Integer(size_px.x()).Integer(size_px.y()).Close(']');
    out_->Key("size_mm").Open('[').Ratio(size_mm.x()).Ratio(size_mm.y()).Close(']');
    Priors(photograph->priors);
    if (!photograph->camera_file.empty()) {
      out_->Key("camera_file").String(photograph->camera_file);
      out_->Key("format_is_stated").Boolean(photograph->format_is_stated);
    }
    if (!photograph->estimate) return;
    out_->Key("camera").Open('[');
    for (int i = 0; i < camera::kParameters; ++i) {
      const bool free = photograph->estimate->parameters[i].free();
      out_->Ratio(free ? std::nan("") : photograph->estimate->camera.parameters[i]);
    }
    out_->Close(']');
  }
  void operator()(const model::TracePtr& trace) {
    out_->Key("dots").Open('[');
    for (const geom::Vec2& dot : trace->dots_px) {
      out_->Open('[').Ratio(dot.x()).Ratio(dot.y()).Close(']');
    }
    out_->Close(']').Key("numbers").Open('[');
    for (const model::Value& number : trace->numbers) out_->Length(number.number());
    out_->Close(']');
    if (trace->kind == model::Trace::Kind::kDirection && trace->axis >= 0) {
      out_->Key("axis").String(
          std::string_view("xyz").substr(static_cast<std::size_t>(trace->axis), 1));
    }
    out_->Key("noise_px").Ratio(trace->noise_px).Key("facade").String(trace->facade);
    if (trace->samples > 0) out_->Key("samples").Ratio(trace->samples);
  }
  void operator()(const model::FacadePtr& facade) {
    out_->Key("facade").String(facade->name);
    Frame(facade->plane, out_);
  }
  void operator()(const model::OrthophotoPtr& made) {
    out_->Key("facade").String(made->facade).Key("pixel_m").Length(made->pixel_m);
    out_->Key("width_px").Integer(made->size_px.x()).Key("height_px").Integer(made->size_px.y());
    Frame(made->plane, out_);
  }
  void operator()(const geom::Line& line) {
    out_->Key("start").Point(line.start).Key("end").Point(line.end);
  }
  void operator()(const geom::Arc& arc) {
    out_->Key("radius").Length(arc.radius).Key("sweep_rad").Ratio(arc.sweep_rad);
    Frame(arc.frame, out_);
  }
  void operator()(const geom::Circle& circle) {
    out_->Key("radius").Length(circle.radius);
    Frame(circle.frame, out_);
  }
  void operator()(const geom::Polyline& polyline) {
    Points("vertices", polyline.vertices, out_);
    out_->Key("closed").Boolean(polyline.closed);
  }
  void operator()(const geom::BsplineCurve& curve) {
    out_->Key("degree").Integer(curve.degree);
    Ratios("knots", curve.knots, out_);
    Points("poles", curve.poles, out_);
    Ratios("weights", curve.weights, out_);
  }
  void operator()(const geom::Chain& chain) {
    out_->Key("segments").Open('[');
    for (const geom::Segment& segment : chain.segments) {
      out_->Open('{');
      std::visit(*this, segment);
      out_->Close('}');
    }
    out_->Close(']').Key("closed").Boolean(chain.closed);
  }
  void operator()(const geom::BsplineSurface& surface) {
    out_->Key("degree_u").Integer(surface.degree_u).Key("degree_v").Integer(surface.degree_v);
    out_->Key("count_u").Integer(surface.count_u).Key("count_v").Integer(surface.count_v);
    Ratios("knots_u", surface.knots_u, out_);
    Ratios("knots_v", surface.knots_v, out_);
    Points("poles", surface.poles, out_);
    Ratios("weights", surface.weights, out_);
  }
  void operator()(const geom::CoonsPatch& patch) {
    Side("south", patch.south);
    Side("north", patch.north);
    Side("west", patch.west);
    Side("east", patch.east);
  }

 private:
  void Priors(const camera::Prior (&priors)[camera::kIntrinsics]) {
    out_->Key("priors").Open('{');
    for (int i = 0; i < camera::kIntrinsics; ++i) {
      if (!(priors[i].sigma > 0)) continue;
      out_->Key(camera::kParameterNames[i]).Open('[');
      out_->Ratio(priors[i].value).Ratio(priors[i].sigma).Close(']');
    }
    out_->Close('}');
  }
  void Side(std::string_view key, const geom::BsplineCurve& curve) {
    out_->Key(key).Open('{');
    (*this)(curve);
    out_->Close('}');
  }
  void Outline(const geom::Curve& curve) {
    out_->Open('{');
    std::visit(*this, curve);
    out_->Close('}');
  }
  void Write(const model::Instance& instance) {
    const model::Prototype& prototype = *instance.prototype;
    out_->Key("prototype").String(model::Hex(prototype.hash));
    const geom::Affine& world = instance.world_from_prototype;
    out_->Key("axes").Open('[');
    for (int column = 0; column < 3; ++column) out_->Direction(world.linear().col(column));
    out_->Close(']').Key("origin").Point(world.translation());
    if (!known_->insert(prototype.hash).second) return;
    out_->Key("parts").Open('[');
    for (const model::ElementPtr& part : prototype.parts) WriteElement(*part, known_, out_);
    out_->Close(']');
  }

  KnownPrototypes* known_;
  JsonText* out_;
};

void Attributes(const model::Attributes& attributes, JsonText* out) {
  static const model::Attributes kUsual;
  out->Key("attributes").Open('{');
  if (attributes.colour != kUsual.colour) out->Key("co").String(model::Describe(attributes.colour));
  if (attributes.linestyle != kUsual.linestyle) out->Key("lc").Integer(attributes.linestyle);
  if (attributes.weight != kUsual.weight) out->Key("wt").Integer(attributes.weight);
  if (attributes.level != kUsual.level) out->Key("lv").String(attributes.level);
  if (!attributes.material.empty()) out->Key("mt").String(attributes.material);
  if (attributes.evidence != kUsual.evidence)
    out->Key("ev").String(model::WordOf(attributes.evidence));
  if (!attributes.source.empty()) out->Key("source").String(attributes.source);
  out->Close('}');
}

}  // namespace

void WriteElement(const model::Element& element, KnownPrototypes* known, JsonText* out) {
  out->Open('{').Key("id").Integer(element.id).Key("type").String(model::TypeOf(element));
  if (element.name) out->Key("name").String(*element.name);
  out->Key("hash").String(model::Hex(element.hash));
  Attributes(*element.attributes, out);
  out->Key("geometry").Open('{');
  std::visit(GeometryWriter(known, out), element.geometry);
  out->Close('}').Close('}');
}

}  // namespace tranos::session
