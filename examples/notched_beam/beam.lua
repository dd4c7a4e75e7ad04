-- The beam of Han 2010, example 4.2, for the scripts beside this file: blocks of any first mesh, supports, notch.
local cdem = require "cdem"

local beam = { length = 1.23, height = 0.30, depth = 0.03, notch_x = 0.435, notch_height = 0.03 } -- m
beam.midspan = beam.length / 2
beam.meshes = { "41x10", "21x5", "82x20", "turned", "voronoi" }
beam.supports = { "pinned", "roller", "face" }
-- One of the paths the paper's pictures allow, from an independent program of the same method.
beam.reference = { {0.435, 0}, {0.449, 0.06}, {0.480, 0.09}, {0.510, 0.116}, {0.540, 0.142}, {0.570, 0.172}, {0.599, 0.21} }

-- Paths that follow the largest hoop stress at the tip (Erdogan and Sih 1963), plane strain, from an independent
-- finite-element program: quadratic triangles of 0.5 mm at the tip, K by the interaction integral, 10 mm a step.
beam.hoop_stress_path = {
  pinned = { {0.435, 0}, {0.435, 0.030}, {0.441, 0.059}, {0.451, 0.088}, {0.464, 0.115}, {0.480, 0.140},
             {0.499, 0.164}, {0.520, 0.185}, {0.543, 0.204}, {0.568, 0.220}, {0.594, 0.236}, {0.616, 0.256} },
  roller = { {0.435, 0}, {0.435, 0.030}, {0.438, 0.060}, {0.443, 0.089}, {0.449, 0.119}, {0.455, 0.148},
             {0.462, 0.177}, {0.468, 0.207}, {0.473, 0.236}, {0.476, 0.266}, {0.477, 0.286} },
  face = { {0.435, 0}, {0.435, 0.030}, {0.443, 0.059}, {0.457, 0.086}, {0.474, 0.110}, {0.494, 0.132},
             {0.517, 0.152}, {0.541, 0.170}, {0.566, 0.187}, {0.590, 0.204}, {0.613, 0.223}, {0.618, 0.232} },
}

local size = {beam.length, beam.height, beam.depth}

-- Cubes of 0.03 m in rows that rise by 15 degrees, cut off at the beam's sides.
local function turned_grid()
  local n, edge = 48, 0.03
  local middle = {beam.length / 2, beam.height / 2, 0}
  local shape = cdem.grid{ size = {n * edge, 22 * edge, beam.depth}, divisions = {n, 22, 1},
                           origin = {middle[1] - n / 2 * edge, middle[2] - 11 * edge, 0} }
  shape = cdem.rotate{ shape = shape, axis = {0, 0, 1}, angle = 15, centre = middle }
  for _, side in ipairs{ { {0, 0, 0}, {1, 0, 0} }, { size, {1, 0, 0} }, { {0, 0, 0}, {0, 1, 0} }, { size, {0, 1, 0} } } do
    shape = cdem.cut_by_plane{ shape = shape, point = side[1], normal = side[2] }
  end
  return cdem.keep{ shape = shape, inside = { min = {0, 0, 0}, max = size } }
end

-- The blocks of one of beam.meshes. The notch is cut into them where it is, whatever their faces, and so is the line of
-- the load where no node lies on it.
function beam.shape(mesh, seed)
  local shape
  if mesh == "turned" then
    shape = turned_grid()
  elseif mesh == "voronoi" then
    shape = cdem.voronoi{ size = size, count = 400, seed = seed, extruded = true }
  else
    local nx, ny = mesh:match("(%d+)x(%d+)")
    shape = cdem.grid{ size = size, divisions = {tonumber(nx), tonumber(ny), 1} }
  end
  if mesh == "turned" or mesh == "voronoi" then
    shape = cdem.cut_by_plane{ shape = shape, point = {beam.midspan, 0, 0}, normal = {1, 0, 0},
                               crossing = { min = {beam.midspan - 1e-6, beam.height - 1e-6, 0},
                                            max = {beam.midspan + 1e-6, beam.height, beam.depth} } }
  end
  local notch = { min = {beam.notch_x - 1e-4, 0, 0}, max = {beam.notch_x + 1e-4, beam.notch_height, beam.depth} }
  shape = cdem.cut_by_plane{ shape = shape, point = {0, beam.notch_height, 0}, normal = {0, 1, 0}, crossing = notch }
  return cdem.cut_by_plane{ shape = shape, point = {beam.notch_x, 0, 0}, normal = {1, 0, 0}, crossing = notch }
end

beam.rock = cdem.elastic{ youngs_modulus = 27.4e9, poissons_ratio = 0.25, density = 2500 }
beam.joint = cdem.mohr_coulomb{ cohesion = 10e6, friction_angle = 30, tensile_strength = 2e6 }

local function near(a, b) return math.abs(a - b) < 1e-9 end
local function bottom(low, high)
  return cdem.select.where(function(x, y) return near(y, 0) and x > low - 1e-9 and x < high + 1e-9 end)
end

-- Bodies (as for cdem.model) made into a beam with its supports and its notch. Plane strain. The load line gets no load.
--   pinned: the bottom edges of both ends held; roller: the right one free along x; face: 0.03 m of the bottom held.
function beam.model(bodies, support, contacts)
  local model = cdem.model{ bodies = bodies, contacts = contacts }
  local reach = support == "face" and 0.03 or 0
  model:select{ name = "left support", on = bottom(0, reach) }
  model:select{ name = "right support", on = bottom(beam.length - reach, beam.length) }
  local function above_midspan(x, y) return near(y, beam.height) and near(x, beam.midspan) end
  model:select{ name = "load line", on = cdem.select.where(above_midspan) }
  model:fix{ on = {"z-", "z+"}, axes = "z" }
  model:fix{ on = "left support" }
  model:fix{ on = "right support", axes = support == "roller" and "yz" or "xyz" }
  model:break_bonds{ on = cdem.select.box{ min = {beam.notch_x - 1e-6, 0, 0},
                                      max = {beam.notch_x + 1e-6, beam.notch_height, beam.depth} }, whole_faces = true }
  return model
end

-- How far the notch's lips have moved apart, m.
function beam.crack_mouth_opening(model)
  local function lip(side) return model:at("displacement.x", {beam.notch_x + side * 1e-6, 1e-6, beam.depth / 2}) end
  return lip(1) - lip(-1)
end

return beam
