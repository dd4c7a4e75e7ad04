#include "libcdem/vtk/scene.hpp"

#include "libcdem/vtk/offscreen.hpp"
#include "libcdem/vtk/ribbons.hpp"
#include "libcdem/vtk/water_line.hpp"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkLight.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cdem {
namespace {

using geom::Vec3;

constexpr Colour edge_colour = {0.13, 0.13, 0.13}, outline_colour = {0.5, 0.5, 0.5};
// Shares of the light on a coloured face: from all round, and from the lamps. A face that looks away from both keeps the first.
constexpr double coloured_ambient = 0.82, coloured_diffuse = 0.2;
constexpr double broken_width = 6; // pixels of a 1600 x 1200 picture
constexpr double from_side = 0.03; // share of a triangle's area that the viewer sees, below it only its line

void set_points(vtkPolyData* mesh, const std::vector<Vec3>& points) {
  vtkNew<vtkPoints> out;
  out->SetDataTypeToDouble();
  out->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    out->SetPoint(static_cast<vtkIdType>(i), points[i].data());
  mesh->SetPoints(out);
}

void set_triangles(vtkPolyData* mesh, const std::vector<geom::Triangle>& triangles) {
  vtkNew<vtkCellArray> cells;
  cells->AllocateExact(static_cast<vtkIdType>(triangles.size()),
                       static_cast<vtkIdType>(3 * triangles.size()));
  for (const geom::Triangle& t : triangles)
    cells->InsertNextCell({t[0], t[1], t[2]});
  mesh->SetPolys(cells);
}

// Number of each point among those in one place: faces may have points of their own.
std::vector<int> places_of(const std::vector<Vec3>& points) {
  std::vector<int> order(points.size()), place(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto coordinates = [&](int i) {
    return std::array<double, 3>{points[i].x(), points[i].y(), points[i].z()};
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return coordinates(a) < coordinates(b); });
  for (std::size_t i = 1; i < order.size(); ++i)
    place[order[i]] = place[order[i - 1]] + (points[order[i]] == points[order[i - 1]] ? 0 : 1);
  return place;
}

// Share of a triangle's area that the viewer sees, below 0 from its back.
double facing(const geom::Triangle& t, const std::vector<Vec3>& points, const View& view) {
  const Vec3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
  return (b - a).cross(c - a).normalized().dot(view.direction_to_viewer((a + b + c) / 3));
}

std::array<int, 2> edge_between(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

// Edges of faces that look at the viewer, between places, sorted. The others are hidden by their own block; their first
// pixels would come through where they leave a corner. Joints that are drawn alone are seen from the side, too.
std::vector<std::array<int, 2>> seen_edges(const Snapshot& s, const std::vector<Vec3>& points,
                                           const std::vector<int>& place, const View& view) {
  const double least = s.outline.empty() ? 0 : -from_side;
  std::vector<std::array<int, 2>> edges;
  for (const geom::Triangle& t : s.surface) {
    if (!(facing(t, points, view) > least))
      continue;
    for (int k = 0; k < 3; ++k)
      edges.push_back(edge_between(place[t[k]], place[t[(k + 1) % 3]]));
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

// True when nearly all of the surface that faces the viewer is square to the line of sight: a plate seen from
// the front. Such a picture is drawn without shading.
bool flat_to_viewer(const Snapshot& s, const std::vector<Vec3>& points, const View& view) {
  double square = 0, seen = 0;
  for (const geom::Triangle& t : s.surface) {
    const Vec3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    const Vec3 area = 0.5 * (b - a).cross(c - a);
    const double facing = area.dot(view.toward), size = area.norm();
    if (facing > 0.1 * size) {
      seen += facing;
      square += facing > 0.995 * size ? facing : 0;
    }
  }
  return square > 0.95 * seen;
}

bool without_colour(const SceneInput& in, std::size_t triangle) {
  if (!in.field)
    return true;
  if (!in.field->on_points)
    return std::isnan(in.field->values[triangle]);
  const geom::Triangle& t = in.snapshot.surface[triangle];
  return std::any_of(t.begin(), t.end(), [&](int p) { return std::isnan(in.field->values[p]); });
}

double median_edge_pixels(const Snapshot& s, const std::vector<Vec3>& points, const View& view) {
  std::vector<double> lengths;
  for (const auto& e : s.block_edges) {
    const Vec3 d = points[e[1]] - points[e[0]];
    const double length = std::hypot(view.right.dot(d), view.up.dot(d)) / view.metres_per_pixel;
    if (length > 0.1)
      lengths.push_back(length);
  }
  if (lengths.empty())
    return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

// Lines that mark joints have this width; among small blocks thicker ones would merge.
double marked_width(const SceneInput& in, const View& view) {
  return std::clamp(0.07 * median_edge_pixels(in.snapshot, in.points, view), 1.5 * in.pixel,
                    broken_width * in.pixel);
}

} // namespace

struct Scene::Impl {
  vtkNew<vtkRenderer> behind, renderer; // behind: bodies without colour, and water; where there is water
  bool has_water = false;

  vtkActor* add(vtkPolyData* mesh, vtkRenderer* where = nullptr) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(mesh);
    mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetInterpolationToFlat();
    (where ? where : renderer.Get())->AddActor(actor);
    return actor;
  }
  // Null if there is nothing to add.
  vtkActor* add_unlit(const std::vector<Vec3>& points, const std::vector<geom::Triangle>& triangles,
                      const Colour& colour) {
    if (triangles.empty())
      return nullptr;
    vtkNew<vtkPolyData> mesh;
    set_points(mesh, points);
    set_triangles(mesh, triangles);
    vtkActor* actor = add(mesh);
    actor->GetProperty()->SetColor(colour[0], colour[1], colour[2]);
    actor->GetProperty()->LightingOff();
    return actor;
  }
  // The surface triangles of these numbers.
  void add_body(const SceneInput&, const View&, const std::vector<std::size_t>& shown, vtkRenderer*);
  void add_joints_from_side(const SceneInput&, const View&);
  void add_broken(const SceneInput&, const View&);
  void add_water(const SceneInput&, const View&);
  static void set_camera(const SceneInput&, const View&, vtkRenderer*);
};

void Scene::Impl::add_body(const SceneInput& in, const View& view, const std::vector<std::size_t>& shown,
                           vtkRenderer* where) {
  if (shown.empty())
    return;
  std::vector<geom::Triangle> triangles;
  triangles.reserve(shown.size());
  for (const std::size_t t : shown)
    triangles.push_back(in.snapshot.surface[t]);
  vtkNew<vtkPolyData> mesh;
  set_points(mesh, in.points);
  set_triangles(mesh, triangles);
  vtkActor* actor = add(mesh, where);
  vtkProperty* property = actor->GetProperty();
  property->BackfaceCullingOn(); // blocks are closed: nobody sees the inside of a face
  property->SetOpacity(in.opacity);
  property->SetColor(plain_block_colour[0], plain_block_colour[1], plain_block_colour[2]);
  // Plain blocks are shaded; coloured ones so little that their colours are found on the colour bar, and their shape seen.
  if (flat_to_viewer(in.snapshot, in.points, view)) {
    property->LightingOff();
  } else {
    property->SetAmbient(in.field ? coloured_ambient : 0.6);
    property->SetDiffuse(in.field ? coloured_diffuse : 0.45);
  }
  if (!in.field)
    return;
  vtkMapper* mapper = actor->GetMapper();
  mapper->ScalarVisibilityOn();
  if (in.field->on_points && in.scale.map != "categorical") {
    // Numbers are interpolated over a face and coloured then, so bands keep the colours of the bar.
    vtkNew<vtkDoubleArray> values;
    values->SetNumberOfValues(static_cast<vtkIdType>(in.field->values.size()));
    std::copy(in.field->values.begin(), in.field->values.end(), values->GetPointer(0));
    mesh->GetPointData()->SetScalars(values);
    vtkNew<vtkLookupTable> table;
    const int n = 512;
    table->SetNumberOfTableValues(n);
    table->SetTableRange(in.scale.low, in.scale.high);
    for (int i = 0; i < n; ++i) {
      const Colour c = in.scale(in.scale.low + (in.scale.high - in.scale.low) * (i + 0.5) / n);
      table->SetTableValue(i, c[0], c[1], c[2]);
    }
    const Colour none = in.scale(std::nan(""));
    table->SetNanColor(none[0], none[1], none[2], 1);
    mapper->SetLookupTable(table);
    mapper->UseLookupTableScalarRangeOn();
    mapper->InterpolateScalarsBeforeMappingOn();
    mapper->SetScalarModeToUsePointData();
    return;
  }
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  const std::size_t count = in.field->on_points ? in.field->values.size() : shown.size();
  colours->SetNumberOfTuples(static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const Colour c = in.scale(in.field->values[in.field->on_points ? i : shown[i]]);
    for (int k = 0; k < 3; ++k)
      colours->SetTypedComponent(
          static_cast<vtkIdType>(i), k,
          static_cast<unsigned char>(std::lround(255 * c[static_cast<std::size_t>(k)])));
  }
  mapper->SetColorModeToDirectScalars();
  if (in.field->on_points) {
    mesh->GetPointData()->SetScalars(colours);
    mapper->SetScalarModeToUsePointData();
  } else {
    mesh->GetCellData()->SetScalars(colours);
    mapper->SetScalarModeToUseCellData();
  }
}

// Joints that are square to the picture show no face: a strip in the colour of the face stands for it.
void Scene::Impl::add_joints_from_side(const SceneInput& in, const View& view) {
  if (!in.field || in.field->on_points)
    return;
  Ribbons ribbons(view, marked_width(in, view), 3);
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  for (std::size_t t = 0; t < in.snapshot.surface.size(); ++t) {
    const geom::Triangle& triangle = in.snapshot.surface[t];
    if (std::abs(facing(triangle, in.points, view)) > from_side)
      continue;
    const Colour c = in.scale(in.field->values[t]);
    for (int k = 0; k < 3; ++k)
      ribbons.add(in.points[triangle[k]], in.points[triangle[(k + 1) % 3]], false);
    while (colours->GetNumberOfTuples() < static_cast<vtkIdType>(ribbons.triangles.size()))
      colours->InsertNextTuple3(std::round(255 * c[0]), std::round(255 * c[1]), std::round(255 * c[2]));
  }
  if (vtkActor* strips = add_unlit(ribbons.points, ribbons.triangles, edge_colour)) {
    vtkPolyDataMapper::SafeDownCast(strips->GetMapper())->GetInput()->GetCellData()->SetScalars(colours);
    strips->GetMapper()->ScalarVisibilityOn();
    strips->GetMapper()->SetColorModeToDirectScalars();
    strips->GetMapper()->SetScalarModeToUseCellData();
  }
}

void Scene::Impl::add_broken(const SceneInput& in, const View& view) {
  const double width = marked_width(in, view), casing = 0.25 * width;
  const auto outline = [&](const BrokenInterfaces::Part& part, double wide, double lift, bool round,
                           double extension, const Colour& colour) {
    Ribbons ribbons(view, wide, lift * width);
    for (const auto& e : part.outline)
      ribbons.add(in.broken->points[e[0]], in.broken->points[e[1]], round, extension);
    add_unlit(ribbons.points, ribbons.triangles, colour);
  };
  // White casing below the colours keeps them apart from whatever the faces show. Its ends are square: round
  // ones face the viewer and would come through the coloured strip where that leans away.
  for (const auto* part : {&in.broken->tension, &in.broken->shear})
    outline(*part, width + 2 * casing, 1, false, casing, {1, 1, 1});
  outline(in.broken->shear, width, 1.5, true, 0, shear_colour);
  outline(in.broken->tension, width, 1.7, true, 0, tension_colour);
  add_unlit(in.broken->points, in.broken->tension.triangles, tension_colour);
  add_unlit(in.broken->points, in.broken->shear.triangles, shear_colour);
}

void Scene::Impl::add_water(const SceneInput& in, const View& view) {
  Ribbons net(view, in.pixel, 1), line(view, 3.5 * in.pixel, 3);
  net.shortest = line.shortest = 0.02;
  for (const WaterSheet& sheet : in.water) {
    if (sheet.triangles.empty())
      continue;
    vtkNew<vtkPolyData> mesh;
    set_points(mesh, sheet.points);
    set_triangles(mesh, sheet.triangles);
    vtkProperty* property = add(mesh, behind)->GetProperty();
    property->SetColor(water_colour[0], water_colour[1], water_colour[2]);
    property->SetOpacity(water_opacity);
    property->SetAmbient(0.7);
    property->SetDiffuse(0.35);
    for (const std::array<int, 2>& e : sheet.net)
      net.add(sheet.points[e[0]], sheet.points[e[1]], false);
  }
  for (const Segment& s : in.water_line)
    line.add(s[0], s[1], false, 0.5 * in.pixel);
  Ribbons arrows(view, 2.5 * in.pixel, 4);
  for (const Polyline& arrow : in.arrows)
    for (std::size_t i = 1; i < arrow.points.size(); ++i)
      arrows.add(arrow.points[i - 1], arrow.points[i], false);
  add_unlit(arrows.points, arrows.triangles, water_line_colour);
  add_unlit(net.points, net.triangles, water_colour);
  add_unlit(line.points, line.triangles, water_line_colour);
}

void Scene::Impl::set_camera(const SceneInput& in, const View& view, vtkRenderer* renderer) {
  vtkCamera* camera = renderer->GetActiveCamera();
  const Vec3 position = view.focal_point + view.distance * view.toward;
  camera->SetFocalPoint(view.focal_point.data());
  camera->SetPosition(position.data());
  camera->SetViewUp(view.up.data());
  camera->SetParallelProjection(!view.perspective);
  camera->SetParallelScale(0.5 * view.metres_per_pixel * view.frame.height);
  camera->SetViewAngle(view.view_angle);
  geom::Box extent = view.extent(in.points);
  for (const WaterSheet& sheet : in.water)
    for (const geom::Triangle& t : sheet.triangles)
      for (const int p : t)
        extent.extend(view.in_view(sheet.points[p]));
  const double camera_depth = view.toward.dot(position);
  const double slack = 30 * view.metres_per_pixel + 1e-3 * view.distance;
  const double far = camera_depth - extent.min.z() + slack, near = camera_depth - extent.max.z() - slack;
  camera->SetClippingRange(view.perspective ? std::max(near, 1e-3 * view.distance) : near,
                           std::max(far, near + slack));
  for (const auto& [place, strength] :
       {std::pair<Vec3, double>{{-0.4, 0.9, 1.1}, 1.}, {{0.9, -0.2, 0.6}, 0.2}}) {
    vtkNew<vtkLight> light;
    light->SetLightTypeToCameraLight();
    light->SetPosition(place.x(), place.y(), place.z());
    light->SetFocalPoint(0, 0, 0);
    light->SetIntensity(strength);
    renderer->AddLight(light);
  }
}

Scene::Scene(const SceneInput& in, const View& view, const std::array<int, 2>& size)
    : impl_(std::make_unique<Impl>()) {
  const std::array<double, 4> viewport = viewport_of(view.frame, size);
  const bool water = !in.water.empty();
  std::vector<std::size_t> plain, coloured;
  for (std::size_t t = 0; t < in.snapshot.surface.size(); ++t)
    (water && without_colour(in, t) ? plain : coloured).push_back(t);
  impl_->add_body(in, view, plain, impl_->behind);
  impl_->add_body(in, view, coloured, impl_->renderer);
  if (water)
    impl_->add_water(in, view);
  if (in.edges) {
    // Thinner lines for smaller blocks: the outlines of many small blocks would else hide their colours.
    const double width =
        std::clamp(0.03 * median_edge_pixels(in.snapshot, in.points, view), 0.3, 1.8 * in.pixel);
    Ribbons ribbons(view, width, 2);
    const std::vector<int> place = places_of(in.snapshot.points); // where tets that moved apart were one
    const auto seen = seen_edges(in.snapshot, in.points, place, view);
    for (const auto& e : in.snapshot.block_edges)
      if (std::binary_search(seen.begin(), seen.end(), edge_between(place[e[0]], place[e[1]])))
        ribbons.add(in.points[e[0]], in.points[e[1]], false);
    impl_->add_unlit(ribbons.points, ribbons.triangles, edge_colour);
    Ribbons outline(view, 2.5 * in.pixel, 0);
    for (const auto& e : in.snapshot.outline)
      outline.add(in.points[e[0]], in.points[e[1]], false);
    impl_->add_unlit(outline.points, outline.triangles, outline_colour);
  }
  if (!in.snapshot.outline.empty())
    impl_->add_joints_from_side(in, view);
  if (in.broken)
    impl_->add_broken(in, view);
  impl_->has_water = water;
  if (water)
    impl_->renderer->PreserveDepthBufferOn();
  for (vtkRenderer* renderer : renderers()) {
    renderer->SetViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    renderer->AutomaticLightCreationOff();
    Impl::set_camera(in, view, renderer);
  }
}
Scene::~Scene() = default;
std::vector<vtkRenderer*> Scene::renderers() {
  if (impl_->has_water)
    return {impl_->behind, impl_->renderer};
  return {impl_->renderer};
}

} // namespace cdem
