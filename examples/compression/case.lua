-- A concrete prism between platens, crushed on three unstructured meshes: peak beside Mohr and Coulomb's strength, then on
-- through the shear band to the fragments.
--
--   ./cdem run examples/compression/case.lua [--set ends=held] [--set sizes=0.014]
local cdem = require "cdem"

local sizes = cdem.parameter{ name = "sizes", default = {0.025, 0.018, 0.014}, range = {0.003, 0.05}, unit = "m",
                              doc = "edges of the tetrahedra, one run each" }
local ends = cdem.parameter{ name = "ends", default = "smooth", choices = {"smooth", "held"},
                             doc = "smooth: they slide on the platens; held: they stick, as rough platens make them" }
local shortening = cdem.parameter{ name = "shortening", default = 6e-3, range = {1e-4, 0.1}, doc = "over the height" }
local speed = cdem.parameter{ name = "speed", default = 0.15, range = {1e-3, 10}, unit = "m/s", doc = "of the platen" }
local frames = cdem.parameter{ name = "frames", default = 0, range = {0, 500}, doc = "of a film of the finest, if any" }

local depth = cdem.parameter{ name = "depth", default = 0.1, range = {1e-3, 1}, unit = "m" }
local g2 = cdem.parameter{ name = "g2", default = 1000, range = {1, 1e6}, unit = "m" }
local strain = cdem.parameter{ name = "plane_strain", default = false }
local width, height = 0.1, 0.2
local cohesion, phi = 7.5e6, 37 -- concrete of 30 MPa
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400 }
local joint = cdem.mohr_coulomb{ cohesion = cohesion, friction_angle = phi, tensile_strength = 3e6, softening = "linear",
                                 fracture_energy_1 = 100, fracture_energy_2 = g2 }
local strength = 2 * cohesion * math.tan(math.rad(45 + phi / 2))
local samples, ramp = 80, 8
local figures, curves, ledger = {}, {}, {}
local function add(name, value, more)
  local figure = more or {}
  figure.name, figure.value = name, value
  figures[#figures + 1] = figure
end

local function crush(size, finest)
  local began = cdem.elapsed()
  local mesh = cdem.solid.box{ size = {width, depth, height} }:mesh{ size = size }
  local model = cdem.model{ bodies = { { name = "prism", shape = mesh, material = concrete, joint = joint,
                                         bond_type = "cohesive" } },
                            contacts = { { "prism", "prism", cdem.coulomb{ friction_angle = phi } } } }
  local axes = ends == "held" and "xyz" or "z"
  model:fix{ on = "z-", axes = axes }
  if strain then model:fix{ on = {"y-", "y+"}, axes = "y" } end
  if ends == "smooth" then
    model:fix{ on = cdem.select.box{ min = {0, 0, 0}, max = {0, 0, 0} }, axes = "xy" }
    model:fix{ on = cdem.select.box{ min = {width, 0, 0}, max = {width, 0, 0} }, axes = "y" }
  end
  local curve = { strain = {0}, stress = {0}, breaking = {0}, friction = {0}, kinetic = {0}, elastic = {0} }
  local top, sum, n, pictures = 0, 0, 0, {}
  local function listen()
    sum, n = sum + (model:reaction("z-")[3] - model:reaction("z+")[3]) / 2, n + 1
  end
  for i = 1, samples do
    -- A smooth start: the velocity grows over the first samples, of a tenth of the way together.
    local v = speed * math.min(1, (i - 0.5) / ramp)
    local steps = shortening * height / speed / (samples - ramp / 2)
    model:fix{ on = "z+", axes = axes, velocity = {0, 0, -v} }
    model:run{ duration = steps, every = 20, callback = listen }
    top = top + v * steps
    local e = model:energy()
    local k = #curve.strain + 1
    curve.strain[k], curve.stress[k] = (top - v * steps / 2) / height, sum / n / (width * depth)
    curve.breaking[k], curve.friction[k], curve.kinetic[k] = e.breaking, e.friction, e.kinetic
    curve.elastic[k] = e.elastic + e.springs
    curve.peak = math.max(curve.peak or 0, curve.stress[k])
    curve.balance = math.max(curve.balance or 0, e.balance_error)
    sum, n = 0, 0
    if i % 4 == 0 then
    cdem.log(string.format("strain %.3g stress %.4g (%.3f) breaking %.4g fric %.3g kin %.3g el %.3g bal %.2e wall %.0f", curve.strain[k], curve.stress[k], curve.stress[k]/strength, e.breaking, e.friction, e.kinetic, e.elastic, e.balance_error, cdem.elapsed()))
    end
  end
  return model, curve
end
for i, size in ipairs(sizes) do
  local model, curve = crush(size, i == #sizes)
  cdem.log(string.format("peak %.4f tets %d fragments %d", curve.peak / strength, model:counts().tets, #model:fragments()))
  model:picture{ file = "p" .. i .. ".png", view = "front", up = "z", colour = "displacement.magnitude", deformation = 10 }
  model:picture{ file = "q" .. i .. ".png", view = "iso", up = "z", colour = "displacement.x", deformation = 10 }
end
