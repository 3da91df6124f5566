// Embree 4 as a process of its own: `cargo xtask bench kernel` compiles this, starts it and talks to it by lines on
// stdin and stdout. The library is found by its path (first argument) and reached through its public C functions only;
// what of its interface we use is declared here. Files hold little-endian 32-bit numbers.
//
//   scene PATH                              reads meshes and instances            -> ok
//   build SLOT QUALITY ROBUST THREADS       quality 0 low, 1 medium, 2 high       -> ok WALL_NS CPU_NS BYTES
//   rays CLASS OCCLUSION PATH               reads rays, eight floats each         -> ok COUNT
//   run SLOT CLASS WARM N FIRST COUNT ...   N ranges of rays, each by a thread    -> ok CPU_NS (of all threads)
//   hits SLOT CLASS PATH                    writes t, instance and triangle       -> ok
//   drop SLOT                               frees a scene                         -> ok
// Anything that goes wrong is answered by a line that begins with "error".
#define _GNU_SOURCE
#include <dlfcn.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

enum { SLOTS = 8, CLASSES = 8, THREADS_MAX = 2 };
enum { NOTHING = -1 };

// What Embree's interface asks for.
typedef struct Device *RTCDevice;
typedef struct EmbreeScene *RTCScene;
typedef struct EmbreeGeometry *RTCGeometry;
enum { TYPE_TRIANGLE = 0, TYPE_INSTANCE = 121 };
enum { BUFFER_INDEX = 0, BUFFER_VERTEX = 1 };
enum { FORMAT_UINT3 = 0x5003, FORMAT_FLOAT3 = 0x9003, FORMAT_FLOAT3X4_ROW_MAJOR = 0x9134 };
enum { SCENE_FLAG_ROBUST = 1 << 2 };
typedef struct __attribute__((aligned(16))) {
    float org[3], tnear, dir[3], time, tfar;
    uint32_t mask, id, flags;
} Ray;
typedef struct __attribute__((aligned(16))) {
    float ng[3], u, v;
    uint32_t prim, geom, inst[2];
} Hit;
typedef struct {
    Ray ray;
    Hit hit;
} RayHit;
// Room for more than the library uses, whatever it was built with.
typedef struct {
    uint32_t ids[8];
} Context;
typedef struct {
    int flags;
    uint32_t feature_mask;
    Context *context;
    void *filter, *callback;
    float min_width_factor;
} Arguments;

static struct {
    RTCDevice (*new_device)(const char *);
    void (*release_device)(RTCDevice);
    int (*device_error)(RTCDevice);
    void (*monitor_memory)(RTCDevice, bool (*)(void *, ssize_t, bool), void *);
    RTCScene (*new_scene)(RTCDevice);
    void (*release_scene)(RTCScene);
    void (*scene_quality)(RTCScene, int);
    void (*scene_flags)(RTCScene, int);
    void (*commit_scene)(RTCScene);
    RTCGeometry (*new_geometry)(RTCDevice, int);
    void (*release_geometry)(RTCGeometry);
    void (*geometry_quality)(RTCGeometry, int);
    void (*shared_buffer)(RTCGeometry, int, unsigned, int, const void *, size_t, size_t, size_t);
    void (*instanced_scene)(RTCGeometry, RTCScene);
    void (*transform)(RTCGeometry, unsigned, int, const void *);
    void (*commit_geometry)(RTCGeometry);
    void (*attach)(RTCScene, RTCGeometry, unsigned);
    void (*intersect)(RTCScene, RayHit *, Arguments *);
    void (*occluded)(RTCScene, Ray *, Arguments *);
} rtc;

typedef struct {
    uint32_t vertices, triangles;
    float *positions;
    uint32_t *indices;
} Mesh;
// A mesh placed by `rows`, or where it is if `moved` is 0.
typedef struct {
    uint32_t mesh, moved;
    float rows[12];
} Instance;
typedef struct {
    float o[3], t_min, d[3], t_max;
} Given;
typedef struct {
    size_t count;
    bool occlusion;
    Given *rays;
} Class;
typedef struct {
    RTCDevice device;
    RTCScene top, *below;
    ssize_t bytes;
} Slot;

static Mesh *meshes;
static Instance *instances;
static uint32_t mesh_count, instance_count;
static Class classes[CLASSES];
static Slot slots[SLOTS];

static uint64_t now(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

static const char *open_library(const char *path) {
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library) return dlerror();
    const struct {
        void *place;
        const char *name;
    } wanted[] = {
        {&rtc.new_device, "rtcNewDevice"},
        {&rtc.release_device, "rtcReleaseDevice"},
        {&rtc.device_error, "rtcGetDeviceError"},
        {&rtc.monitor_memory, "rtcSetDeviceMemoryMonitorFunction"},
        {&rtc.new_scene, "rtcNewScene"},
        {&rtc.release_scene, "rtcReleaseScene"},
        {&rtc.scene_quality, "rtcSetSceneBuildQuality"},
        {&rtc.scene_flags, "rtcSetSceneFlags"},
        {&rtc.commit_scene, "rtcCommitScene"},
        {&rtc.new_geometry, "rtcNewGeometry"},
        {&rtc.release_geometry, "rtcReleaseGeometry"},
        {&rtc.geometry_quality, "rtcSetGeometryBuildQuality"},
        {&rtc.shared_buffer, "rtcSetSharedGeometryBuffer"},
        {&rtc.instanced_scene, "rtcSetGeometryInstancedScene"},
        {&rtc.transform, "rtcSetGeometryTransform"},
        {&rtc.commit_geometry, "rtcCommitGeometry"},
        {&rtc.attach, "rtcAttachGeometryByID"},
        {&rtc.intersect, "rtcIntersect1"},
        {&rtc.occluded, "rtcOccluded1"},
    };
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        void *function = dlsym(library, wanted[i].name);
        if (!function) return wanted[i].name;
        memcpy(wanted[i].place, &function, sizeof function);
    }
    return NULL;
}

static bool read_numbers(FILE *file, void *to, size_t count) { return fread(to, 4, count, file) == count; }

static bool read_mesh(FILE *file, Mesh *mesh) {
    if (!read_numbers(file, &mesh->vertices, 1) || !read_numbers(file, &mesh->triangles, 1)) return false;
    // Embree reads up to 16 bytes at the last vertex.
    mesh->positions = calloc((size_t)mesh->vertices * 3 + 4, 4);
    mesh->indices = calloc((size_t)mesh->triangles * 3 + 4, 4);
    return mesh->positions && mesh->indices && read_numbers(file, mesh->positions, (size_t)mesh->vertices * 3) &&
           read_numbers(file, mesh->indices, (size_t)mesh->triangles * 3);
}

static bool read_scene(const char *path) {
    for (uint32_t i = 0; i < mesh_count; i++) free(meshes[i].positions), free(meshes[i].indices);
    free(meshes), free(instances);
    meshes = NULL, instances = NULL, mesh_count = 0, instance_count = 0;
    FILE *file = fopen(path, "rb");
    if (!file) return false;
    bool good = read_numbers(file, &mesh_count, 1) && (meshes = calloc(mesh_count + 1, sizeof *meshes));
    for (uint32_t i = 0; good && i < mesh_count; i++) good = read_mesh(file, &meshes[i]);
    good = good && read_numbers(file, &instance_count, 1) &&
           (instances = calloc(instance_count + 1, sizeof *instances)) &&
           read_numbers(file, instances, (size_t)instance_count * (sizeof *instances / 4));
    fclose(file);
    return good;
}

static bool read_rays(Class *class, const char *path) {
    free(class->rays);
    class->rays = NULL, class->count = 0;
    FILE *file = fopen(path, "rb");
    if (!file) return false;
    fseek(file, 0, SEEK_END);
    size_t count = (size_t)ftell(file) / sizeof(Given);
    rewind(file);
    class->rays = malloc(count * sizeof(Given) + 1);
    bool good = class->rays && fread(class->rays, sizeof(Given), count, file) == count;
    fclose(file);
    if (good) class->count = count;
    return good;
}

static bool count_bytes(void *bytes, ssize_t change, bool after) {
    (void)after;
    __atomic_add_fetch((ssize_t *)bytes, change, __ATOMIC_RELAXED);
    return true;
}

static void drop(Slot *slot) {
    if (!slot->device) return;
    rtc.release_scene(slot->top);
    for (uint32_t i = 0; i < mesh_count; i++)
        if (slot->below[i]) rtc.release_scene(slot->below[i]);
    free(slot->below);
    rtc.release_device(slot->device);
    memset(slot, 0, sizeof *slot);
}

static RTCGeometry triangles(const Slot *slot, const Mesh *mesh, int quality) {
    RTCGeometry geometry = rtc.new_geometry(slot->device, TYPE_TRIANGLE);
    rtc.geometry_quality(geometry, quality);
    rtc.shared_buffer(geometry, BUFFER_VERTEX, 0, FORMAT_FLOAT3, mesh->positions, 0, 12, mesh->vertices);
    rtc.shared_buffer(geometry, BUFFER_INDEX, 0, FORMAT_UINT3, mesh->indices, 0, 12, mesh->triangles);
    rtc.commit_geometry(geometry);
    return geometry;
}

static RTCScene empty_scene(const Slot *slot, int quality, bool robust) {
    RTCScene scene = rtc.new_scene(slot->device);
    rtc.scene_quality(scene, quality);
    rtc.scene_flags(scene, robust ? SCENE_FLAG_ROBUST : 0);
    return scene;
}

// The tree of a mesh that is placed somewhere; built when first asked for.
static RTCScene below(Slot *slot, uint32_t mesh, int quality, bool robust) {
    if (!slot->below[mesh]) {
        slot->below[mesh] = empty_scene(slot, quality, robust);
        RTCGeometry geometry = triangles(slot, &meshes[mesh], quality);
        rtc.attach(slot->below[mesh], geometry, 0);
        rtc.release_geometry(geometry);
        rtc.commit_scene(slot->below[mesh]);
    }
    return slot->below[mesh];
}

static void build_trees(Slot *slot, int quality, bool robust) {
    slot->top = empty_scene(slot, quality, robust);
    for (uint32_t i = 0; i < instance_count; i++) {
        const Instance *instance = &instances[i];
        RTCGeometry geometry;
        if (instance->moved) {
            geometry = rtc.new_geometry(slot->device, TYPE_INSTANCE);
            rtc.instanced_scene(geometry, below(slot, instance->mesh, quality, robust));
            rtc.transform(geometry, 0, FORMAT_FLOAT3X4_ROW_MAJOR, instance->rows);
            rtc.commit_geometry(geometry);
        } else {
            geometry = triangles(slot, &meshes[instance->mesh], quality);
        }
        rtc.attach(slot->top, geometry, i);
        rtc.release_geometry(geometry);
    }
    rtc.commit_scene(slot->top);
}

static void build(Slot *slot, int quality, bool robust, int threads) {
    drop(slot);
    char config[64];
    snprintf(config, sizeof config, "threads=%d,set_affinity=0", threads);
    slot->device = rtc.new_device(config);
    slot->below = calloc(mesh_count + 1, sizeof *slot->below);
    if (!slot->device || !slot->below) {
        puts("error no device");
        return;
    }
    rtc.monitor_memory(slot->device, count_bytes, &slot->bytes);
    uint64_t wall = now(CLOCK_MONOTONIC), cpu = now(CLOCK_PROCESS_CPUTIME_ID);
    build_trees(slot, quality, robust);
    wall = now(CLOCK_MONOTONIC) - wall, cpu = now(CLOCK_PROCESS_CPUTIME_ID) - cpu;
    int error = rtc.device_error(slot->device);
    if (error)
        printf("error Embree says %d\n", error);
    else
        printf("ok %llu %llu %lld\n", (unsigned long long)wall, (unsigned long long)cpu, (long long)slot->bytes);
}

static Arguments arguments(Context *context) {
    memset(context, 0xff, sizeof *context);
    return (Arguments){.feature_mask = UINT32_MAX, .context = context};
}

static inline Ray as_ray(const Given *given) {
    return (Ray){.org = {given->o[0], given->o[1], given->o[2]},
                 .tnear = given->t_min,
                 .dir = {given->d[0], given->d[1], given->d[2]},
                 .tfar = given->t_max,
                 .mask = UINT32_MAX};
}

static inline RayHit nearest(RTCScene scene, const Given *given, Arguments *arguments) {
    RayHit found;
    found.ray = as_ray(given);
    found.hit.geom = found.hit.inst[0] = found.hit.inst[1] = (uint32_t)NOTHING;
    rtc.intersect(scene, &found, arguments);
    return found;
}

static float trace(RTCScene scene, const Class *class, size_t first, size_t count) {
    Context context;
    Arguments given = arguments(&context);
    float sum = 0;
    for (size_t i = first; i < first + count; i++) {
        if (class->occlusion) {
            Ray ray = as_ray(&class->rays[i]);
            rtc.occluded(scene, &ray, &given);
            sum += ray.tfar;
        } else {
            RayHit found = nearest(scene, &class->rays[i], &given);
            sum += found.ray.tfar;
        }
    }
    return sum;
}

// A thread's part of a timed run.
typedef struct {
    RTCScene scene;
    const Class *class;
    size_t warm, first, count;
    pthread_barrier_t *barrier;
    uint64_t nanoseconds;
    volatile float sum;
} Part;

// What Embree asks its users for: no denormal numbers.
static void flush_denormals(void) {
#if defined(__x86_64__)
    _mm_setcsr(_mm_getcsr() | 0x8040);
#endif
}

static void *run_part(void *given) {
    Part *part = given;
    flush_denormals();
    // The rays before those that are timed, or the last ones of all.
    size_t warm = part->warm < part->class->count ? part->warm : part->class->count;
    size_t start = part->first >= warm ? part->first - warm : part->class->count - warm;
    part->sum = trace(part->scene, part->class, start, warm);
    pthread_barrier_wait(part->barrier);
    uint64_t begin = now(CLOCK_THREAD_CPUTIME_ID);
    part->sum = trace(part->scene, part->class, part->first, part->count);
    part->nanoseconds = now(CLOCK_THREAD_CPUTIME_ID) - begin;
    return NULL;
}

static void run(const Slot *slot, const Class *class, size_t warm, int parts, const size_t *ranges) {
    Part part[THREADS_MAX];
    pthread_t threads[THREADS_MAX];
    pthread_barrier_t barrier;
    pthread_barrier_init(&barrier, NULL, (unsigned)parts);
    for (int i = 0; i < parts; i++)
        part[i] = (Part){slot->top, class, warm, ranges[2 * i], ranges[2 * i + 1], &barrier, 0, 0};
    for (int i = 1; i < parts; i++) pthread_create(&threads[i], NULL, run_part, &part[i]);
    run_part(&part[0]);
    uint64_t sum = part[0].nanoseconds;
    for (int i = 1; i < parts; i++) {
        pthread_join(threads[i], NULL);
        sum += part[i].nanoseconds;
    }
    pthread_barrier_destroy(&barrier);
    printf("ok %llu\n", (unsigned long long)sum);
}

typedef struct {
    float t;
    uint32_t instance, prim;
} Found;

static bool write_hits(const Slot *slot, const Class *class, const char *path) {
    FILE *file = fopen(path, "wb");
    if (!file) return false;
    flush_denormals();
    Context context;
    Arguments given = arguments(&context);
    bool good = true;
    for (size_t i = 0; good && i < class->count; i++) {
        Found found = {-1, (uint32_t)NOTHING, (uint32_t)NOTHING};
        if (class->occlusion) {
            Ray ray = as_ray(&class->rays[i]);
            rtc.occluded(slot->top, &ray, &given);
            if (ray.tfar < 0) found = (Found){0, 0, 0};
        } else {
            RayHit nearest_hit = nearest(slot->top, &class->rays[i], &given);
            const Hit *hit = &nearest_hit.hit;
            bool placed = hit->inst[0] != (uint32_t)NOTHING;
            if (hit->geom != (uint32_t)NOTHING)
                found = (Found){nearest_hit.ray.tfar, placed ? hit->inst[0] : hit->geom, hit->prim};
        }
        good = fwrite(&found, sizeof found, 1, file) == 1;
    }
    return fclose(file) == 0 && good;
}

static void answer(bool good, const char *what) { good ? puts("ok") : printf("error %s\n", what); }

static Slot *built(unsigned slot) { return slot < SLOTS && slots[slot].top ? &slots[slot] : NULL; }

static void obey(char *line) {
    unsigned slot = 0, class = 0, quality = 0, flag = 0, threads = 0;
    size_t warm = 0, range[2 * THREADS_MAX] = {0};
    int parts = 0, at = 0;
    line[strcspn(line, "\n")] = 0;
    if (sscanf(line, "scene %n", &at) == 0 && at) {
        for (int i = 0; i < SLOTS; i++) drop(&slots[i]);
        answer(read_scene(line + at), "cannot read the scene");
    } else if (sscanf(line, "build %u %u %u %u", &slot, &quality, &flag, &threads) == 4 && slot < SLOTS) {
        build(&slots[slot], (int)quality, flag != 0, (int)threads);
    } else if (sscanf(line, "rays %u %u %n", &class, &flag, &at) == 2 && class < CLASSES) {
        classes[class].occlusion = flag != 0;
        answer(read_rays(&classes[class], line + at), "cannot read the rays");
    } else if (sscanf(line, "hits %u %u %n", &slot, &class, &at) == 2 && class < CLASSES && built(slot)) {
        answer(write_hits(built(slot), &classes[class], line + at), "cannot write the hits");
    } else if (sscanf(line, "run %u %u %zu %d %zu %zu %zu %zu", &slot, &class, &warm, &parts, &range[0], &range[1],
                      &range[2], &range[3]) >= 6 &&
               class < CLASSES && parts >= 1 && parts <= THREADS_MAX && built(slot)) {
        bool inside = true;
        for (int i = 0; i < parts; i++) inside = inside && range[2 * i] + range[2 * i + 1] <= classes[class].count;
        inside ? run(built(slot), &classes[class], warm, parts, range) : answer(false, "no such rays");
    } else if (sscanf(line, "drop %u", &slot) == 1 && slot < SLOTS) {
        drop(&slots[slot]);
        answer(true, "");
    } else {
        answer(false, "not understood");
    }
    fflush(stdout);
}

int main(int count, char **words) {
    const char *missing = count == 2 ? open_library(words[1]) : "the path of the library is wanted";
    if (missing) {
        printf("error %s\n", missing);
        return 1;
    }
    puts("ok");
    fflush(stdout);
    static char line[8192];
    while (fgets(line, sizeof line, stdin)) obey(line);
    return 0;
}
