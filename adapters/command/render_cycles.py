"""Renders a scene with Blender's Cycles: SCENE OUTPUT SAMPLES SEED THREADS.

What makes it the same question (each found by measurement, with bpy 5.0.1): roulette, clamping, filters of gloss, light
tree and adaptive sampling are off; roughness is the root of alpha; a light emits on its front only where
`emission_sampling` says so and a back face is mixed to black; a point light has 4π times its intensity; the first
sample of every pixel goes through its middle, which is a bias where few are taken, and is left out.
"""

import math
import os
import sys
import time

import bpy

# These come with bpy, and are there once it is.
import addon_utils
import bmesh
import mathutils
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import furnace_scene as furnace

SUBDIVISIONS = 7

path, output, samples, seed, threads = furnace.arguments()
scene = furnace.read(path)
if scene.last_bounce < 1:
    furnace.refuse("light that has not bounced")
width, height = scene.size
bpy.ops.wm.read_factory_settings(use_empty=True)
addon_utils.enable("cycles")
stage = bpy.context.scene


def colour(rgb):
    return (*map(float, rgb), 1.0)


def make_material(look, radiance):
    made = bpy.data.materials.new("material")
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    values = look.values
    if look.kind == "diffuse":
        surface = nodes.new("ShaderNodeBsdfDiffuse")
        surface.inputs["Color"].default_value = colour(values["reflectance"])
        surface.inputs["Roughness"].default_value = 0
    elif look.kind == "conductor":
        surface = nodes.new("ShaderNodeBsdfAnisotropic")
        surface.inputs["Color"].default_value = colour(values["specular_reflectance"])
        surface.inputs["Roughness"].default_value = 0
    elif look.kind == "roughconductor":
        surface = nodes.new("ShaderNodeBsdfAnisotropic")
        surface.distribution = "GGX"
        surface.inputs["Color"].default_value = colour(values["specular_reflectance"])
        surface.inputs["Roughness"].default_value = math.sqrt(values["alpha"])
    elif look.kind == "dielectric":
        if any(value != 1 for name in ("reflectance", "transmittance") for value in values[f"specular_{name}"]):
            furnace.refuse("tinted glass")
        surface = nodes.new("ShaderNodeBsdfGlass")
        surface.inputs["Color"].default_value = colour((1, 1, 1))
        surface.inputs["Roughness"].default_value = 0
        surface.inputs["IOR"].default_value = values["int_ior"]
    else:
        furnace.refuse(f"material {look.kind}")
    end = surface.outputs["BSDF"]
    if radiance is not None:
        end = glow(nodes, links, end, radiance)
        made.cycles.emission_sampling = "FRONT"
    result = nodes.new("ShaderNodeOutputMaterial")
    links.new(end, result.inputs["Surface"])
    return made


def glow(nodes, links, surface, radiance):
    """Adds emission on the front side."""
    strength = max(radiance)
    emission = nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value = colour(radiance / strength if strength else radiance)
    emission.inputs["Strength"].default_value = strength
    both = nodes.new("ShaderNodeAddShader")
    links.new(surface, both.inputs[0])
    links.new(emission.outputs["Emission"], both.inputs[1])
    side = nodes.new("ShaderNodeMixShader")
    geometry = nodes.new("ShaderNodeNewGeometry")
    links.new(geometry.outputs["Backfacing"], side.inputs["Fac"])
    links.new(both.outputs["Shader"], side.inputs[1])
    links.new(surface, side.inputs[2])
    return side.outputs["Shader"]


def place(mesh, look, radiance):
    mesh.materials.append(make_material(look, radiance))
    thing = bpy.data.objects.new("shape", mesh)
    stage.collection.objects.link(thing)
    return thing


for shape in scene.meshes:
    mesh = bpy.data.meshes.new("mesh")
    mesh.from_pydata(shape.positions.tolist(), [], shape.triangles.tolist())
    if shape.normals is not None:
        mesh.shade_smooth()
        mesh.normals_split_custom_set_from_vertices(shape.normals.tolist())
    place(mesh, shape.material, shape.radiance)
for shape in scene.spheres:
    mesh = bpy.data.meshes.new("sphere")
    build = bmesh.new()
    bmesh.ops.create_icosphere(build, subdivisions=SUBDIVISIONS, radius=1)
    if shape.inward:
        bmesh.ops.reverse_faces(build, faces=build.faces)
    # With the volume of the sphere, its silhouette is right to 1e-4.
    size = shape.radius * (4 / 3 * math.pi / abs(build.calc_volume())) ** (1 / 3)
    build.to_mesh(mesh)
    build.free()
    mesh.shade_smooth()
    thing = place(mesh, shape.material, shape.radiance)
    thing.location = shape.centre.tolist()
    thing.scale = (size,) * 3

world = bpy.data.worlds.new("world")
stage.world = world
world.use_nodes = True
background = world.node_tree.nodes["Background"]
background.inputs["Color"].default_value = (0, 0, 0, 1)
background.inputs["Strength"].default_value = 1
for kind, values in scene.lights:
    if kind == "point":
        strength = max(values["intensity"])
        light = bpy.data.lights.new("point", "POINT")
        light.energy = 4 * math.pi * strength
        light.color = (values["intensity"] / strength).tolist()
        light.shadow_soft_size = 0
        thing = bpy.data.objects.new("point", light)
        thing.location = values["position"].tolist()
        stage.collection.objects.link(thing)
    elif kind == "constant":
        background.inputs["Color"].default_value = colour(values["radiance"])
    else:
        furnace.refuse(f"light {kind}")

camera = bpy.data.cameras.new("camera")
camera.sensor_fit = "HORIZONTAL"
camera.angle = math.radians(scene.camera.horizontal_fov)
camera.clip_start, camera.clip_end = scene.camera.near, scene.camera.far
eye = bpy.data.objects.new("camera", camera)
backward = scene.camera.origin - scene.camera.target
backward /= numpy.linalg.norm(backward)
right = numpy.cross(scene.camera.up, backward)
right /= numpy.linalg.norm(right)
axes = numpy.eye(4)
axes[:3] = numpy.stack([right, numpy.cross(backward, right), backward, scene.camera.origin], axis=1)

eye.matrix_world = mathutils.Matrix(axes.tolist())
stage.collection.objects.link(eye)
stage.camera = eye

render, cycles = stage.render, stage.cycles
render.engine = "CYCLES"
render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
render.threads_mode, render.threads = "FIXED", max(threads, 1)
cycles.device = "CPU"
cycles.samples, cycles.seed = samples + 1, seed
# The first goes through the middle of the pixel, whatever the seed.
cycles.use_sample_subset, cycles.sample_offset, cycles.sample_subset_length = True, 1, samples
cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_light_tree = False
cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
cycles.light_sampling_threshold = 0
cycles.blur_glossy = 0
cycles.caustics_reflective = cycles.caustics_refractive = True
cycles.pixel_filter_type, cycles.filter_width = "BOX", 1
cycles.max_bounces = max(scene.last_bounce - 1, 0)
for kind in ("diffuse", "glossy", "transmission"):
    setattr(cycles, f"{kind}_bounces", cycles.max_bounces)
cycles.min_light_bounces = cycles.min_transparent_bounces = 1024
stage.view_settings.view_transform = "Raw"
stage.display_settings.display_device = "sRGB"
settings = render.image_settings
settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGB"
settings.exr_codec = "NONE"
render.filepath = output + ".exr"
bpy.ops.render.render(write_still=True)
picture = bpy.data.images.load(output + ".exr")
picture.colorspace_settings.name = "Non-Color"
pixels = numpy.empty(width * height * 4, dtype=numpy.float32)
picture.pixels.foreach_get(pixels)
# Blender counts rows from the bottom.
furnace.write_pfm(output, pixels.reshape(height, width, 4)[::-1, :, :3])
print("seconds", time.process_time())
