"""The Cycles side of cycles.py, which writes the job and has Blender run this:

  blender -b --factory-startup --python cycles_blender.py -- JOB.json

The same cloud, view, sun and sky as a scene of ours, for Cycles on the CPU; one PFM a seed.
Lengths in metres, in the program's own frame. Writes JSON: CPU s of each picture.
"""
import array
import json
import math
import os
import pathlib
import resource
import sys

import bpy
from mathutils import Vector


def cpu_s():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def cloud(job):
    volume = bpy.data.volumes.new("cloud")
    volume.filepath = job["vdb"]
    volume.render.clipping = 0
    volume.render.precision = "FULL"
    material = bpy.data.materials.new("water")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    scatter = nodes.new("ShaderNodeVolumeScatter")
    scatter.inputs["Color"].default_value = (1, 1, 1, 1)
    scatter.inputs["Anisotropy"].default_value = job["asymmetry"]
    field = nodes.new("ShaderNodeAttribute")
    field.attribute_name = job["grid"]
    scale = nodes.new("ShaderNodeMath")
    scale.operation = "MULTIPLY"
    scale.inputs[1].default_value = job["density_scale"]
    links.new(field.outputs["Fac"], scale.inputs[0])
    links.new(scale.outputs[0], scatter.inputs["Density"])
    links.new(scatter.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Volume"])
    volume.materials.append(material)
    thing = bpy.data.objects.new("cloud", volume)
    if job["up"] == "y":
        thing.rotation_euler = (math.pi / 2, 0, 0)
    bpy.context.collection.objects.link(thing)


def light(job):
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy = 1
    sun.color = job["irradiance"]
    sun.angle = 2 * job["sun_radius_rad"]
    lamp = bpy.data.objects.new("sun", sun)
    lamp.rotation_euler = Vector(job["to_sun"]).to_track_quat("Z", "Y").to_euler()
    bpy.context.collection.objects.link(lamp)
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*job["sky"], 1)
    background.inputs["Strength"].default_value = 1
    bpy.context.scene.world = world


def camera(job):
    data = bpy.data.cameras.new("eye")
    data.sensor_fit = "VERTICAL"
    data.angle_y = job["vertical_fov_rad"]
    data.clip_start, data.clip_end = 0.1, 1e6
    eye = bpy.data.objects.new("eye", data)
    eye.location = job["eye_m"]
    towards = Vector(job["target_m"]) - Vector(job["eye_m"])
    eye.rotation_euler = towards.to_track_quat("-Z", "Y").to_euler()  # z is up
    bpy.context.collection.objects.link(eye)
    bpy.context.scene.camera = eye


def quality(job):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = job["width"], job["height"]
    scene.render.resolution_percentage = 100
    scene.render.threads_mode = "FIXED"
    scene.render.threads = len(os.sched_getaffinity(0))
    scene.render.use_persistent_data = False
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.color_mode = "RGB"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = job["light_threshold"]
    cycles.max_bounces = cycles.volume_bounces = job["bounces"]
    cycles.volume_step_rate, cycles.volume_max_steps = job["step_rate"], 65536
    # Through the middles of pixels, as ours.
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 0.01
    cycles.samples = job["spp"]


def write_pfm(exr, pfm):
    image = bpy.data.images.load(exr)
    image.colorspace_settings.name = "Raw"
    width, height = image.size
    values = list(image.pixels)
    rgb = array.array("f", (v for i, v in enumerate(values) if i % 4 != 3))
    with open(pfm, "wb") as out:
        out.write(f"PF\n{width} {height}\n-1.0\n".encode())
        rgb.tofile(out)
    bpy.data.images.remove(image)
    os.remove(exr)


def main():
    job = json.loads(pathlib.Path(sys.argv[sys.argv.index("--") + 1]).read_text())
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    if job["vdb"]:
        cloud(job)
    light(job)
    camera(job)
    quality(job)
    rows = []
    for seed, pfm in zip(job["seeds"], job["pictures"]):
        bpy.context.scene.cycles.seed = seed
        exr = pfm + ".exr"
        bpy.context.scene.render.filepath = exr
        start = cpu_s()
        bpy.ops.render.render(write_still=True)
        spent = cpu_s() - start
        write_pfm(exr, pfm)
        rows.append(spent)
    result = {"cpu_s": rows, "blender": bpy.app.version_string}
    pathlib.Path(job["result"]).write_text(json.dumps(result))


main()
