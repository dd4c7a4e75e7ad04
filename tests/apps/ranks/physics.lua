-- One small model of each kind, solved until it has done what is particular to it; the hash of each, and that it has.
-- stops: in the middle of each stage, behind a place where it can be left, the script waits for a signal, the first time.
local cdem = require "cdem"

local only = cdem.parameter{ name = "only", default = "plate beam unit pile collapse shatter", doc = "cases" }

local stops = cdem.parameter{ name = "stops", default = 0, doc = "1: waits in each stage for a signal" }

local stiff = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }
local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500, stiffness_damping = 1e-6 }
local weak = cdem.mohr_coulomb{ cohesion = 3e5, friction_angle = 35, tensile_strength = 1e5 }
local rough = cdem.coulomb{ friction_angle = 30 }
local figures, of = {}, "?"

local function told(model, what, value)
  figures[#figures + 1] = { name = of .. ": " .. what, value = value }
  figures[#figures + 1] = { name = of .. ": hash", value = model.state_hash }
end

-- In every step from 210 on of a stage, which can be left at 200.
local function half_way(stage)
  local looks = 0
  return function()
    looks = looks + 1
    if stops == 0 or looks ~= 1 or io.open(stage .. ".seen") then return end
    io.open(stage .. ".seen", "w"):close()
    print("half of " .. stage)
    local till = os.time() + 60
    while os.time() < till do end
  end
end

local function floor()
  return { shape = cdem.solid.box{ size = {3, 3, 0.3}, origin = {-1.5, -1.5, -0.3} }:mesh{ size = 1 }, material = rock,
           element = "rigid", name = "floor" }
end

local cases = {}

-- Blocks of small strain, relaxed until bonds break; then cut, and run on.
function cases.plate()
  local model = cdem.model{ bodies = { { shape = cdem.grid{ size = {1.2, 0.5, 0.05}, divisions = {16, 7, 1} },
    material = stiff, joint = weak, name = "plate", element = "small_strain" } } }
  model:fix{ on = "y-" }
  model:traction{ on = "y+", stress = {1e5, 1.3e5, 0} }
  model:relax{ max_steps = 120 }
  model:refine{ tension_threshold = 0.5, shear_threshold = 0.5 }
  model:run{ steps = 230, every = 210, callback = half_way "plate" }
  told(model, "breaks", #model:breaks())
end

-- A notched beam of a cohesive mesh that cracks.
function cases.beam()
  local joint = cdem.mohr_coulomb{ cohesion = 3e6, friction_angle = 35, tensile_strength = 1e6, softening = "linear",
                                   fracture_energy_1 = 20, fracture_energy_2 = 200 }
  local model = cdem.model{ bodies = { { shape = cdem.box_mesh{ size = {0.6, 0.2, 0.1}, divisions = {6, 2, 1}, jitter = 0.15 },
    material = stiff, joint = joint, name = "beam", bonds = "cohesive" } } }
  model:fix{ on = "x-", velocity = {-0.1, 0, 0} }
  model:fix{ on = "x+", velocity = {0.1, 0, 0} }
  model:run{ steps = 240, every = 210, callback = half_way "beam" }
  told(model, "breaks", #model:breaks())
end

-- An armour unit of a few hundred tets that a flow pushes over and breaks.
function cases.unit()
  local unit = cdem.accropode{ mass = 500, density = 2500 }
  local model = cdem.model{ bodies = { floor(), { shape = unit:translate{
    shift = {0, 0, 0.5 * unit.height + 1e-3} }:mesh{ size = unit.height / 3 }, material = rock, joint = weak, name = "unit" } },
    contacts = { { "floor", "unit", rough }, { "unit", "unit", rough } } }
  model:fix{ on = "floor" }
  model:gravity{ vector = {0, 0, -9.81} }
  model:flow{ on = "unit", direction = {1, 0, 0}, velocity = 30 }
  model:initial_velocity{ on = "unit", velocity = {0, 0, -6} }
  model:run{ steps = 250, every = 210, callback = half_way "unit" }
  told(model, "broken", #model:breaks() > 0)
end

-- Units that fall as rigid bodies, rest, deform, and are pushed on.
function cases.pile()
  local unit = cdem.accropode{ mass = 500, density = 2500 }
  local mesh = unit:mesh{ size = unit.height / 2 }
  local slope = cdem.slope{ gradient = 1 / 1.5, length = 4, width = 3 }:mesh{ size = 1.5 }
  local pile = cdem.drop{ unit = mesh, count = 3, onto = slope, seed = 2, layers = 1 }
  local model = cdem.model{ bodies = { { shape = slope, material = rock, element = "rigid", name = "slope" },
    { shape = pile, material = rock, name = "units" } },
    contacts = { { "slope", "units", rough }, { "units", "units", rough } } }
  model:fix{ on = "slope" }
  model:gravity{ vector = {0, 0, -9.81} }
  model:watch{ body = "units", leaves = 0.3 }
  model:settle{ max_time = 0.5, every = 220, callback = half_way "settle" }
  model:flow{ on = "units", direction = {1, 0, 0}, velocity = 4 }
  model:run{ steps = 230, every = 210, callback = half_way "flow" }
  told(model, "kinetic energy", model:energy().kinetic)
end

-- Voronoi blocks that hold by friction alone, thrown on a floor.
function cases.collapse()
  local cells = cdem.translate{ shape = cdem.voronoi{ size = {0.8, 0.8, 0.8}, count = 8, seed = 3 },
                                shift = {-0.4, -0.4, 0.01} }
  local model = cdem.model{ bodies = { floor(), { shape = cells, material = rock, joint = weak, name = "heap",
    element = "finite_volume" } }, contacts = { default = rough } }
  model:fix{ on = "floor" }
  model:gravity{ vector = {0, 0, -9.81} }
  model:initial_velocity{ on = "heap", velocity = {1, 0, -5}, angular_velocity = {0, 3, 0} }
  model:run{ steps = 400, every = 210, callback = half_way "collapse" }
  told(model, "breaks", #model:breaks())
end

-- A cube that falls to pieces where it hits a floor.
function cases.shatter()
  local cube = cdem.solid.box{ size = {0.5, 0.5, 0.5}, origin = {-0.25, -0.25, 5e-3} }:mesh{ size = 0.2 }
  local model = cdem.model{ bodies = { floor(), { shape = cube, material = rock, joint = weak, name = "cube",
    bonded_faces = "all", bonds = "springs" } },
    contacts = { { "floor", "cube", rough }, { "cube", "cube", rough } } }
  model:fix{ on = "floor" }
  model:initial_velocity{ on = "cube", velocity = {1, 0, -8} }
  model:run{ steps = 380, every = 210, callback = half_way "shatter" }
  told(model, "breaks", #model:breaks())
end

for name in only:gmatch "%a+" do
  of = name
  cases[name]()
end
cdem.report(figures)
