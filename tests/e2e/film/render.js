// Draws a body as a webcam sees it. Called by make.py.

import * as THREE from "./vendor/three.module.min.js";

const WIDTH = 640, HEIGHT = 480;
let renderer, world, camera, mesh, lamp;

window.setUp = ({ faces, colours, eye, look, fov }) => {
  renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.setSize(WIDTH, HEIGHT);
  renderer.shadowMap.enabled = true;
  renderer.toneMapping = THREE.NeutralToneMapping;
  document.body.append(renderer.domElement);
  world = new THREE.Scene();
  world.background = new THREE.Color(0xcfcac2);
  camera = new THREE.PerspectiveCamera(fov, WIDTH / HEIGHT, 0.05, 20);
  camera.position.set(...eye);
  camera.lookAt(...look);
  const sun = new THREE.DirectionalLight(0xfff4e6, 2.2);
  sun.position.set(-1.2, 2.2, -1.2);
  sun.target.position.set(...look);
  sun.castShadow = true;
  sun.shadow.mapSize.set(1024, 1024);
  sun.shadow.normalBias = 0.02;
  Object.assign(sun.shadow.camera, { left: -1.5, right: 1.5, top: 1.5, bottom: -1.5 });
  world.add(sun, sun.target, new THREE.HemisphereLight(0xffffff, 0xb0a89c, 1.6));
  const wall = new THREE.Mesh(new THREE.PlaneGeometry(8, 5), new THREE.MeshStandardMaterial({ color: 0xcdc6b8 }));
  wall.position.set(0, 0.5, 2.6);
  wall.rotation.y = Math.PI;
  wall.receiveShadow = true;
  const shelf = new THREE.Mesh(new THREE.BoxGeometry(0.9, 0.05, 0.3), new THREE.MeshStandardMaterial({ color: 0x7a5b3e }));
  shelf.position.set(-0.9, 0.45, 2.45);
  lamp = new THREE.Mesh(new THREE.CircleGeometry(0.16, 40), new THREE.MeshBasicMaterial({ color: 0xffffff, toneMapped: false }));
  lamp.position.set(1.1, 0.75, 2.55);
  lamp.rotation.y = Math.PI;
  world.add(wall, shelf, lamp);
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(faces);
  geometry.setAttribute("color", new THREE.Float32BufferAttribute(colours, 3));
  mesh = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.75, side: THREE.DoubleSide }));
  mesh.castShadow = mesh.receiveShadow = true;
  mesh.frustumCulled = false;
  world.add(mesh);
};

window.draw = (vertices, lit) => {
  lamp.visible = lit;
  mesh.geometry.setAttribute("position", new THREE.Float32BufferAttribute(vertices, 3));
  mesh.geometry.computeVertexNormals();
  renderer.render(world, camera);
  return renderer.domElement.toDataURL("image/jpeg", 0.75);
};
