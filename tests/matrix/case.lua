-- A random model, drawn from `seed`, that runs through random stages and prints what it is like after each. `way` says how
-- it is run: looked at, saved, stopped ... None of this may change a bit. run.sh compares the ways.
local cdem = require "cdem"
local seed = cdem.parameter{ name = "seed", default = 1 }
-- plain, empty, read, files, divided, stop, stranger, breaking_stranger
local way = cdem.parameter{ name = "way", default = "plain" }
local beside = way == "stranger" or way == "breaking_stranger"
local every = cdem.parameter{ name = "callback_every", default = 3 }
local stop_at = cdem.parameter{ name = "stop_at", default = 7 } -- call of the callback; for stop
local without = cdem.parameter{ name = "without", default = "", doc = "features to leave out, separated by commas" }

-- Numbers that only the seed and the order of the draws decide (Park and Miller's generator).
local state = (seed * 48271 + 11) % 2147483647
local function random(low, high)
  state = state * 48271 % 2147483647
  return low + (high - low) * state / 2147483647
end
local function chance(p) return random(0, 1) < p end
local function pick(list) return list[1 + math.floor(random(0, #list) * 0.999999)] end
local function rounded(low, high) return tonumber(string.format("%.4g", random(low, high))) end

-- A feature is drawn whether or not it is left out, so that the others stay what they are.
local function with(name, p)
  local drawn = chance(p)
  return drawn and not ("," .. without .. ","):find("," .. name .. ",", 1, true)
end

local function with_of_seed(name, every_so_many)
  return seed % every_so_many == 2 and not ("," .. without .. ","):find("," .. name .. ",", 1, true)
end

local function text(x) return string.format("%.17g", x) end
-- What does not fit together is refused, which is as good an answer as any, if it is the same in every way.
local function try(what, act)
  local ok, message = pcall(act)
  if not ok then print("REFUSED", what, (tostring(message):gsub("\n", " "):sub(1, 120))) end
end

local materials = {
  cdem.elastic{ youngs_modulus = 1e8, poissons_ratio = 0.2, density = 2500 },
  cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.25, density = 2500, stiffness_damping = 1e-6 },
  cdem.elastic{ youngs_modulus = 5e9, poissons_ratio = 0, density = 3000 } }

local function strength(kind)
  local tension = rounded(3e3, 2e5)
  local law = { tensile_strength = tension, cohesion = rounded(2, 4) * tension, friction_angle = rounded(15, 40) }
  if with("softening", 0.4) and kind ~= "springs" then
    law.softening, law.fracture_energy_1, law.fracture_energy_2 = pick{ "linear", "exponential" }, 40, 400
  elseif with("weibull", 0.2) then
    law.weibull = { modulus = 5, reference_volume = 1e-3, seed = seed }
  end
  if with("rate", 0.15) and kind == "cohesive" then law.rate_effect = { reference_rate = 1e-3, exponent = 0.03 } end
  return cdem.mohr_coulomb(law)
end

local function body(number, kind, origin)
  local size = { rounded(0.3, 0.6), rounded(0.3, 0.5), rounded(0.2, 0.4) }
  local spec = { name = "b" .. number, material = pick(materials) }
  local function mesh() return cdem.solid.box{ size = size, origin = origin }:mesh{ size = rounded(0.15, 0.25) } end
  local function blocks(shape) return cdem.translate{ shape = shape, shift = origin } end
  if kind == "plain" then
    spec.shape = mesh()
  elseif kind == "plastic" then
    spec.shape, spec.plasticity = mesh(), cdem.plastic{ cohesion = 2e4, friction_angle = 20, tensile_strength = 1e4,
      residual_cohesion = 5e3, residual_friction_angle = 20, residual_tensile_strength = 1e3, softening_strain = 0.01 }
  elseif kind == "cohesive" or kind == "springs" then
    spec.shape, spec.joint, spec.bonds = mesh(), strength(kind), kind
  elseif kind == "rigid" then
    spec.shape, spec.element = mesh(), "rigid"
  elseif kind == "grid" then
    spec.shape, spec.joint = blocks(cdem.grid{ size = size, divisions = { 2, 2, 1 } }), strength()
    if with("zones", 0.3) then spec.zone_size = 0.15 end
  elseif kind == "voronoi" then
    spec.shape, spec.joint = blocks(cdem.voronoi{ size = size, count = 5, seed = seed }), strength()
  elseif kind == "dry" then
    spec.shape, spec.joint = blocks(cdem.grid{ size = size, divisions = { 2, 1, 2 } }), cdem.coulomb{ friction_angle = 30 }
  end
  return spec
end

local count, kinds, bodies = 1 + math.floor(random(0, 2.999)), {}, {}
bodies[1] = { name = "floor", material = materials[2],
  shape = chance(0.5) and cdem.solid.box{ size = { 4, 3, 0.3 }, origin = { -2, -1.5, -0.3 } }:mesh{ size = 1 }
    or cdem.box{ size = { 4, 3, 0.3 }, origin = { -2, -1.5, -0.3 } } }
if with("rigid_floor", 0.4) then bodies[1].element = "rigid" end
for i = 1, count do
  kinds[i] = pick{ "plain", "plastic", "cohesive", "cohesive", "springs", "springs", "rigid", "grid", "voronoi", "dry" }
  bodies[#bodies + 1] = body(i, kinds[i], { -1.4 + 0.9 * (i - 1) + rounded(0, 0.1), -0.2, 0.003 })
end
local names = {}
for i, spec in ipairs(bodies) do names[i] = spec.name end
if beside then
  bodies[#bodies + 1] = { name = "stranger", -- so soft that it does not decide the time step
    material = cdem.elastic{ youngs_modulus = 1e6, poissons_ratio = 0.2, density = 3000 },
    shape = cdem.solid.box{ size = { 0.4, 0.4, 0.4 }, origin = { 1000, 0, 0 } }:mesh{ size = 0.4 } }
end
if way == "breaking_stranger" then -- it is torn from its top
  local stranger = bodies[#bodies]
  stranger.shape = cdem.solid.box{ size = { 0.4, 0.4, 0.6 }, origin = { 1000, 0, 0 } }:mesh{ size = 0.2 }
  stranger.joint = cdem.mohr_coulomb{ tensile_strength = 3e3, cohesion = 9e3, friction_angle = 30 }
  stranger.bonds = seed % 2 == 0 and "cohesive" or "springs"
end
local rubbing = { friction_angle = rounded(10, 40) }
if with("restitution", 0.4) then rubbing.restitution = rounded(0.01, 0.9) end
local model = cdem.model{ bodies = bodies, contacts = { default = cdem.coulomb(rubbing) } }
print("MODEL", seed, table.concat(kinds, " "))
if way == "stranger" then model:fix{ on = "stranger" } end
if way == "breaking_stranger" then
  model:fix{ on = cdem.select.where(function(x, _, z) return x > 900 and z > 0.599 end) }
  model:initial_velocity{ on = "stranger", velocity = { 0, 0, -5 } }
end
model:fix{ on = "floor" }
model:gravity{ vector = { rounded(-1, 1), 0, -9.81 } }

for i = 1, count do
  local on = "b" .. i
  if with("velocity", 0.8) then
    local motion = { on = on, velocity = { rounded(-2, 2), rounded(-1, 1), rounded(-9, 0) } }
    if with("spin", 0.5) then motion.angular_velocity = { rounded(-3, 3), rounded(-3, 3), rounded(-3, 3) } end
    try("velocity", function() model:initial_velocity(motion) end)
  end
  if with("traction", 0.3) then
    local load = { on = on, stress = { rounded(-3e4, 3e4), 0, rounded(-3e4, 0) } }
    if chance(0.5) then load.amplitude = { { 0, 0 }, { 0.005, 1 } } end
    try("traction", function() model:traction(load) end)
  end
  if with("flow", 0.2) then
    local flow = { on = on, direction = { 1, 0.2, 0 }, velocity = rounded(1, 8), relative = chance(0.5) }
    try("flow", function() model:flow(flow) end)
  end
end
if with("water", 0.15) then try("water", function() model:water{ level = 0.15 } end) end
-- Drawn from the seed alone, so that the other features stay what they are.
if with_of_seed("waves", 4) then
  model:gravity{ vector = { 0, 0, -9.81 } }
  local water = seed % 3 == 0 and cdem.water.uniform{ velocity = { 0.5, 0.2, 0 }, level = 0.2 }
    or cdem.water.wave{ height = 0.2, period = 1.5, depth = 1.5, level = 0.25 }
  for i = 1, count do
    try("waves", function() model:flow{ on = "b" .. i, water = water, drag = 1, added_mass = seed % 2 == 0 and 0.5 or 0 } end)
  end
end
if with_of_seed("gas", 3) then
  for i = 1, count do
    local load = { on = "b" .. i, pressure = 2e5, amplitude = { { 0, 0 }, { 0.01, 1 } } }
    if seed % 2 == 0 then load.pressure, load.volume, load.bulk_modulus, load.reservoir = nil, 1e-3, 1e8, 0.01 end
    if kinds[i] == "cohesive" then try("gas", function() model:crack_pressure(load) end) end
  end
end
if with("probe", 0.3) then
  try("probe", function() model:probe{ name = "stress", field = "stress.zz", at = { 0, 0, -0.1 } } end)
end

local calls = 0
local function look()
  calls = calls + 1
  if way == "read" then
    local _ = { model:energy().kinetic, #model:contacts(), model:max("displacement.magnitude"),
      model:min("principal_stress.3"), model.state_hash, #model:breaks(), model:fragments(), model:counts() }
    pcall(function() return model:overlap() end)
  elseif way == "files" then
    model:save{ file = "looked.vtu" }
    if calls == 2 then model:picture{ file = "looked.png", size = { 200, 150 }, colour = "stress.zz" } end
  elseif way == "stop" and calls == stop_at and not io.open("stopped_once") then
    io.open("stopped_once", "w"):close() -- run.sh sees it and sends the signal
    local till = os.time() + 30
    while os.time() < till do end
  end
end

-- on_the_way: a relaxation may have left supports there, and a run moves them within its own time.
local stage, relaxed, on_the_way = 0, false, false
-- A relaxation damps all bodies together: from then on a stranger does make a difference.
local function told_bodies()
  for _, name in ipairs(names) do
    local ok, far = pcall(function() return model:max("displacement.magnitude", name) end)
    local ok_too, press = pcall(function() return model:min("principal_stress.3", name) end)
    if not relaxed then
      print("BODY", stage, text(model.time), name, ok and text(far) or "-", ok_too and text(press) or "-")
    end
  end
end
local function told(what)
  stage = stage + 1
  if beside or way == "plain" then told_bodies() end
  if beside then return end
  local energy = model:energy()
  print("STATE", stage, what, model.state_hash, model.steps, text(model.time), #model:breaks())
  print("ENERGY", stage, text(energy.kinetic), text(energy.elastic), text(energy.springs), text(energy.friction),
    text(energy.damping), text(energy.breaking), text(energy.plastic), text(energy.external))
end

local function solve(options)
  if way == "empty" or way == "read" or way == "files" or way == "stop" then
    options.every, options.callback = way == "stop" and 7 or every, look
  end
  relaxed = relaxed or options.residual ~= nil
  if options.residual then
    model:relax(options)
  elseif way:find("^divided") and not on_the_way then -- looks in between change nothing
    local first = math.min(options.steps - 1, 1 + (17 * seed + 59 * stage) % options.steps)
    model:run{ steps = first, safety = options.safety, breaking = options.breaking }
    local _ = { model:energy().kinetic, model.state_hash, #model:contacts() }
    options.steps = options.steps - first
    model:run(options)
  else
    model:run(options)
    on_the_way = false
  end
end
for _ = 1, 3 + math.floor(random(0, 2.999)) do
  local what = pick{ "run", "run", "run", "relax", "make_rigid", "make_deformable", "remove", "release" }
  local on = "b" .. (1 + math.floor(random(0, count) * 0.999999))
  local steps, safety, breaking = math.floor(random(60, 260)), pick{ 0.4, 0.9 }, chance(0.85)
  if what == "relax" and with("relax", 1) then
    local moved = with_of_seed("moved", 3)
    if moved then try("moved", function() model:fix{ on = "floor", displacement = { 1e-4, 0, -5e-5 } } end) end
    try("relax", function() solve{ residual = 1e-3, max_steps = moved and 300 or 150, breaking = breaking } end)
    on_the_way = moved
  elseif what == "make_rigid" and with("make_rigid", 1) then
    try(what, function() model:make_rigid{ on = on } end)
  elseif what == "make_deformable" and with("make_deformable", 1) then
    try(what, function() model:make_deformable{ on = on } end)
  elseif what == "remove" and with("remove", 1) then
    local gradual, share, time = with("gradual", 0.7), pick{ 0, 0.4, 1 }, pick{ 1e-3, 0.05 }
    -- With a stranger beside it, all of a single body may go; alone it may not.
    local whole = count > 1 and on or cdem.select.where(function(x) return x < -1.2 end)
    local place = pick{ whole, cdem.select.where(function(x) return x > 0 and x < 900 end) }
    try(what, function()
      model:remove{ on = place, relaxed = gradual and share or nil, over = gradual and share > 0 and time or nil }
    end)
  elseif what == "release" then
    try("relax_excavation", function() model:relax_excavation{ over = 0.01 } end)
    try(what, function() model:clear_loads() end)
    try(what, function() model:gravity{ vector = { 0, 0, -9.81 } } end)
  end
  try("run", function() solve{ steps = steps, safety = safety, breaking = breaking } end)
  told(what)
end
print("END")
