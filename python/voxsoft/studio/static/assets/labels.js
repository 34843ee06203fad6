import{S as e,b as t,g as n}from"./units.js";import{i as r}from"./colormaps.js";import{D as i,F as a,I as o,L as s,N as c,T as l,_ as u,a as d,d as f,f as p,i as ee,l as te,n as m,p as ne,r as h,u as re,v as g,w as ie,x as _}from"./three.js";var v=class extends Error{};function y(e){if(e.byteLength<64)throw new v(`message of ${e.byteLength} bytes`);let n=new DataView(e);if(n.getUint32(0,!0)!==826693718)throw new v(`not a message of VoxSoft`);let r=n.getUint8(4);if(r===t.TOPOLOGY)return se(e,n);if(r===t.FRAME)return ce(e,n);if(r===t.SMOOTH)return le(e,n);throw new v(`unknown kind ${r}`)}function ae(e){let t=[];for(let n=0;n<e.byteLength;){let r=y(e.slice(n));t.push(r),n+=oe(r)}return t}function oe(e){if(e.kind===`frame`)return 64+e.packed.byteLength;if(e.kind===`smooth`)return 64+e.vertices.byteLength+e.triangles.byteLength;let{rest:t,triangles:n,edges:r,owners:i}=e,a=t.byteLength+n.byteLength+r.byteLength+i.byteLength;return 64+a+(-a&3)}function se(t,n){let r=n.getUint32(24,!0),i=n.getUint32(28,!0),a=n.getUint32(32,!0);x(t,64+12*r+12*i+8*a+i);let o=64+12*r,s=o+12*i;return{kind:`topology`,id:n.getUint32(8,!0),tets:(n.getUint8(5)&e.SHRUNK_TETS)!==0,voxelSize:n.getFloat64(16,!0),rest:new Float32Array(t,64,3*r),triangles:new Uint32Array(t,o,3*i),edges:new Uint32Array(t,s,2*a),owners:new Uint8Array(t,s+8*a,i)}}function ce(e,t){let r=t.getUint32(24,!0);x(e,64+8*r);let i=t.getUint8(5);return{kind:`frame`,topology:t.getUint32(8,!0),number:t.getUint32(12,!0),time:t.getFloat64(16,!0),seq:t.getUint32(28,!0),field:t.getUint16(6,!0),paused:(i&n.PAUSED)!==0,diverged:(i&n.DIVERGED)!==0,atRest:(i&n.AT_REST)!==0,origin:b(t,32),scale:b(t,44),min:t.getFloat32(56,!0),max:t.getFloat32(60,!0),packed:new Uint16Array(e,64,4*r)}}function le(e,t){let n=t.getUint32(24,!0),r=t.getUint32(28,!0);return x(e,64+12*n+13*r),{kind:`smooth`,topology:t.getUint32(8,!0),vertices:new Float32Array(e,64,3*n),triangles:new Uint32Array(e,64+12*n,3*r),owners:new Uint8Array(e,64+12*n+12*r,r)}}function b(e,t){return[e.getFloat32(t,!0),e.getFloat32(t+4,!0),e.getFloat32(t+8,!0)]}function x(e,t){if(e.byteLength<t)throw new v(`${t} bytes announced, ${e.byteLength} came`)}function ue(e,t){let n=4*t,r=t=>e.origin[t]+e.scale[t]*(e.packed[n+t]??0)/65535;return[r(0),r(1),r(2)]}function S(e,t){return e.min+(e.max-e.min)*(e.packed[4*t+3]??0)/65535}var C=0,w=1,T=2,E=[{button:C,does:`turn`},{button:C,held:`shift`,does:`move`}],D={voxsoft:[{button:T,does:`turn`},{button:w,does:`move`}],onshape:[{button:T,does:`turn`},{button:w,does:`move`},{button:T,held:`ctrl`,does:`move`}],solidworks:[{button:w,does:`turn`},{button:w,held:`ctrl`,does:`move`},{button:w,held:`shift`,does:`zoom`}],blender:[{button:w,does:`turn`},{button:w,held:`shift`,does:`move`},{button:w,held:`ctrl`,does:`zoom`}]},de=[{value:`voxsoft`,label:`VoxSoft`},{value:`onshape`,label:`Onshape`},{value:`solidworks`,label:`SolidWorks`},{value:`blender`,label:`Blender`}],fe=[`left button beside the body`,`middle button`,`right button`],pe={shift:`Shift + `,ctrl:`Ctrl + `},me=[[`turn`,`Turn the view`],[`move`,`Move the view`],[`zoom`,`Zoom`]];function he(e,t){let n=t.shiftKey?`shift`:t.ctrlKey||t.metaKey?`ctrl`:void 0,r=[...D[e],...E].filter(e=>e.button===t.button);return(r.find(e=>e.held===n)??r.find(e=>!e.held))?.does??null}function ge(e,t,n,r){t===`turn`?e.turn(n,r):t===`move`?e.move(n,r):e.zoom(1.006**r,0,0)}function _e(e){let t=[];for(let[n,r]of me){let i=[...D[e],...E].filter(e=>e.does===n).map(e=>(e.held?pe[e.held]:``)+fe[e.button]);i.length>0&&t.push([r,i.join(`, or `)])}return t}var O=`
in vec4 packed;
uniform vec3 uOrigin;
uniform vec3 uScale;
uniform float uExaggeration;
vec3 placed() {
  vec3 now = uOrigin + uScale * packed.xyz;
  return position + uExaggeration * (now - position);
}
`,k=`
uniform sampler2D uLut;
uniform vec2 uFrameRange;
uniform vec2 uRange;
// Where a value stands in the range of colors: 0 to 1, or beyond.
float shareOf(float field) {
  float value = uFrameRange.x + (uFrameRange.y - uFrameRange.x) * field;
  return (value - uRange.x) / max(uRange.y - uRange.x, 1e-30);
}
vec3 colorOf(float share) {
  return texture(uLut, vec2(clamp(share, 0.002, 0.998), 0.5)).rgb;
}
// Outside of a fixed range: stripes on the screen, seen without telling colors apart.
vec3 stripedOf(float share, vec2 at) {
  vec3 base = colorOf(share);
  float beyond = max(share - 1.0, -share);
  if (beyond <= 0.01) return base;
  float stripe = step(0.5, fract((at.x + at.y) / 9.0));
  return mix(base, vec3(share > 1.0 ? 1.0 : 0.15), 0.45 * stripe);
}
`,A=`
uniform vec4 uPlane;
uniform float uSection;
bool cutAway(vec3 at) {
  return uSection > 0.5 && dot(uPlane.xyz, at) > uPlane.w;
}
`,j=`
${O}
out vec3 vWorld;
out vec3 vView;
out float vField;
void main() {
  vWorld = placed();
  vec4 view = modelViewMatrix * vec4(vWorld, 1.0);
  vView = view.xyz;
  vField = packed.w;
  gl_Position = projectionMatrix * view;
}
`,ve=`
precision highp float;
${A}
${k}
in vec3 vWorld;
in vec3 vView;
in float vField;
uniform float uByField;
uniform vec3 uOwn;
uniform float uAlpha;
out vec4 color;
void main() {
  if (cutAway(vWorld)) discard;
  vec3 normal = normalize(cross(dFdx(vView), dFdy(vView)));
  if (normal.z < 0.0) normal = -normal;
  // Mostly ambient: the map's colors must stay those of the legend, the light tells the shape.
  float light = 0.74 + 0.26 * max(0.0, dot(normal, normalize(vec3(0.35, 0.55, 0.75))));
  vec3 base = uOwn;
  if (uByField > 0.5) base = stripedOf(shareOf(vField), gl_FragCoord.xy);
  color = vec4(base * light * (gl_FrontFacing ? 1.0 : 0.82), uAlpha);
}
`,ye=`
precision highp float;
${A}
in vec3 vWorld;
uniform vec3 uOwn;
out vec4 color;
void main() {
  if (cutAway(vWorld)) discard;
  // Threads both ways on the screen, between which the body's own color shows.
  vec2 way = vec2(gl_FragCoord.x + gl_FragCoord.y, gl_FragCoord.x - gl_FragCoord.y) / 10.0;
  vec2 near = smoothstep(0.36, 0.46, abs(fract(way) - 0.5));
  color = vec4(uOwn, mix(0.2, 0.85, max(near.x, near.y)));
}
`,M=`
precision highp float;
${A}
in vec3 vWorld;
out vec4 color;
void main() {
  if (cutAway(vWorld)) discard;
  color = vec4(0.0);
}
`,N=`
${O}
uniform float uVoxelSize;
uniform float uPixels;
uniform float uFade;
out vec3 vWorld;
out float vStrength;
out float vField;
void main() {
  vWorld = placed();
  vField = packed.w;
  vec4 view = modelViewMatrix * vec4(vWorld, 1.0);
  gl_Position = projectionMatrix * view;
  // Side of a voxel on the screen, in pixels; below some, edges would only darken the body.
  float side = uVoxelSize * uPixels * projectionMatrix[1][1] / gl_Position.w;
  vStrength = mix(1.0, smoothstep(3.0, 14.0, side), uFade);
}
`,P=`
precision highp float;
${A}
${k}
in vec3 vWorld;
in float vStrength;
in float vField;
uniform vec4 uInk;
uniform float uByField;
out vec4 color;
void main() {
  if (vStrength < 0.01 || cutAway(vWorld)) discard;
  vec3 ink = uByField > 0.5 ? colorOf(shareOf(vField)) : uInk.rgb;
  color = vec4(ink, uInk.a * vStrength);
}
`,be=`
out vec3 vWorld;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vWorld = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}
`,xe=`
precision highp float;
uniform vec3 uCut;
out vec4 color;
void main() {
  // Hatched, as drawings mark cut material.
  float line = smoothstep(0.0, 1.2, abs(fract((gl_FragCoord.x - gl_FragCoord.y) / 11.0) - 0.5) * 11.0 - 0.2);
  color = vec4(uCut * mix(0.82, 1.0, line), 1.0);
}
`,F=`
out vec2 vAt;
void main() {
  vAt = position.xy * 0.5 + 0.5;
  gl_Position = vec4(position.xy, 1.0, 1.0);
}
`,Se=`
precision highp float;
uniform vec3 uTop;
uniform vec3 uBottom;
in vec2 vAt;
out vec4 color;
void main() {
  // A little noise hides the steps of eight bits in a slow gradient.
  float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) / 255.0;
  color = vec4(mix(uBottom, uTop, smoothstep(0.0, 1.0, vAt.y)) + noise - 0.5 / 255.0, 1.0);
}
`,Ce=`
precision highp float;
uniform sampler2D uPicture;
out vec4 color;
void main() {
  color = vec4(texelFetch(uPicture, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
}
`,we=`
out vec2 vAt;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vAt = world.xy;
  gl_Position = projectionMatrix * viewMatrix * world;
}
`,Te=`
precision highp float;
in vec2 vAt;
uniform float uCell;
uniform vec2 uCenter;
uniform float uReach;
uniform vec3 uInk;
uniform float uFacing;
out vec4 color;
float lines(float cell) {
  vec2 at = vAt / cell;
  vec2 width = fwidth(at);
  vec2 near = abs(fract(at - 0.5) - 0.5) / max(width, 1e-9);
  // Cells smaller than a few pixels fade, or they would shimmer.
  float fade = 1.0 - smoothstep(0.12, 0.45, max(width.x, width.y));
  return (1.0 - min(min(near.x, near.y), 1.0)) * fade;
}
void main() {
  float far = length(vAt - uCenter) / uReach;
  float strength = max(0.38 * lines(uCell), 0.8 * lines(uCell * 5.0));
  strength *= (1.0 - smoothstep(0.25, 1.0, far)) * uFacing;
  if (strength < 0.004) discard;
  color = vec4(uInk, strength);
}
`,I=`#c77dd6`;function Ee(e,t){let n=new c({glslVersion:f,vertexShader:j,fragmentShader:ye,side:2,transparent:!0,depthWrite:!1,polygonOffset:!0,polygonOffsetFactor:-1,polygonOffsetUnits:-1,uniforms:{...t,uOwn:{value:new d(I)}}}),r=new _(e,n);return r.renderOrder=3,r.frustumCulled=!1,r}function L(e,t,n){let r=r=>{let i=r===1?ne:re,a=new c({glslVersion:f,vertexShader:t,fragmentShader:M,uniforms:n,side:r,colorWrite:!1,depthWrite:!1,depthTest:!1,stencilWrite:!0,stencilFunc:519,stencilFail:i,stencilZFail:i,stencilZPass:i}),o=new _(e,a);return o.renderOrder=0,o.frustumCulled=!1,o.visible=!1,o};return[r(1),r(0)]}var R=[`#56b4e9`,`#e78ac3`,`#2fc39b`,`#e8dd55`,`#b9a2f5`,`#e8704a`];function z(e,t){let n=new Uint32Array(256);for(let e of t)n[e]+=1;let r=[],i=new Uint32Array(256),a=0;for(let e=0;e<256;e++){let t=n[e];i[e]=a,t>0&&r.push({owner:e,start:3*a,count:3*t}),a+=t}let o=new Uint32Array(e.length);for(let n=0;n<t.length;n++){let r=3*i[t[n]]++;o[r]=e[3*n],o[r+1]=e[3*n+1],o[r+2]=e[3*n+2]}return{index:o,ranges:r}}var De=class{group=new p;topology;frame=null;triangles=0;attribute;shells=[];edges;ghost;geometries=[];rest;sheets=[];shared;lut;bounds=new m;constructor(e,t){this.topology=e;let n=e.rest.length/3,i=new h(e.rest,3);this.rest=i,this.attribute=new h(new Uint16Array(4*n),4,!0),this.attribute.setUsage(35048),this.lut=new te(r(`viridis`,0),256,1),this.lut.minFilter=this.lut.magFilter=g,this.lut.needsUpdate=!0,this.shared={uOrigin:{value:new o},uScale:{value:new o},uExaggeration:{value:0},uPlane:t.plane,uSection:t.section,uLut:{value:this.lut},uFrameRange:{value:new a(0,1)},uRange:{value:new a(0,1)}};let{index:s,ranges:c}=z(e.triangles,e.owners),l=new h(s,1);for(let e of c)this.shells.push(this.shell(i,l,e));this.edges=this.lines(i,this.shared),this.edges.renderOrder=4,this.ghost=this.lines(i,{...this.shared,uExaggeration:{value:0}}),this.ghost.renderOrder=3,this.group.add(this.edges,this.ghost)}geometry(e,t){let n=new ee;return n.setAttribute(`position`,e),n.setAttribute(`packed`,this.attribute),n.setIndex(t),this.geometries.push(n),n}shell(e,t,n){let r=this.geometry(e,t);r.setDrawRange(n.start,n.count);let i=new c({glslVersion:f,vertexShader:j,fragmentShader:ve,side:2,polygonOffset:!0,polygonOffsetFactor:1,polygonOffsetUnits:1,uniforms:{...this.shared,uByField:{value:1},uOwn:{value:new d(`#e8b88a`)},uAlpha:{value:1}}}),a=new _(r,i);a.renderOrder=2,a.frustumCulled=!1;let o=[...L(r,j,this.shared)];return this.group.add(a,...o),{owner:n.owner,mesh:a,stencils:o}}lines(e,t){let n=this.geometry(e,new h(this.topology.edges,1)),r=new c({glslVersion:f,vertexShader:N,fragmentShader:P,transparent:!0,depthWrite:!1,uniforms:{...t,uVoxelSize:{value:this.topology.voxelSize||1},uPixels:{value:1},uFade:{value:1},uByField:{value:0},uInk:{value:new s(0,0,0,.4)}}}),i=new u(n,r);return i.frustumCulled=!1,i}cover(e){if(!(this.sheets.length>0)){this.sheets=e.map(e=>{let t=new h(new Uint32Array(e.triangles),1);return Ee(this.geometry(this.rest,t),this.shared)});for(let e of this.sheets)this.group.add(e)}}get coloring(){let{uFrameRange:e,uRange:t}=this.shared;return{lut:this.lut,frame:e.value,range:t.value}}suits(e){return e.topology===this.topology.id&&e.packed.length===this.attribute.array.length}setFrame(e){this.frame=e,this.attribute.array=e.packed,this.attribute.needsUpdate=!0,this.shared.uOrigin.value.fromArray(e.origin),this.shared.uScale.value.fromArray(e.scale),this.shared.uFrameRange.value.set(e.min,e.max)}setRange(e,t){this.shared.uRange.value.set(e,t)}setPixels(e){this.edges.material.uniforms.uPixels.value=e,this.ghost.material.uniforms.uPixels.value=e}lutKey=``;style(e,t,n){let i=`${e.colormap} ${e.bands}`;i!==this.lutKey&&(this.lutKey=i,this.lut.image.data.set(r(e.colormap,e.bands)),this.lut.minFilter=this.lut.magFilter=g,this.lut.needsUpdate=!0),this.shared.uExaggeration.value=this.frame?e.exaggeration:0;let a=e.appearance===`wireframe`,o=e.section!==`off`;this.triangles=0;for(let{owner:r,mesh:i,stencils:s}of this.shells){let c=!!(r&128),{uniforms:l}=i.material,u=e.cavities&&!c,d=!this.frame||this.frame.max<=this.frame.min,f=e.coloring===`field`&&!d&&!(e.cavities&&c);l.uByField.value=+!!f,l.uAlpha.value=u?.16:1;let p=c?e.cavities?R[(r&127)%R.length]:t.parts[0]??`#e8b88a`:t.parts[r]??`#e8b88a`;l.uOwn.value.set(p),i.material.transparent!==u&&(i.material.transparent=u,i.material.depthWrite=!u,i.material.needsUpdate=!0),i.renderOrder=u?5:2,i.visible=n&&!a,i.visible&&(this.triangles+=i.geometry.drawRange.count/3);for(let e of s)e.visible=i.visible&&o&&!this.topology.tets}let s=this.edges.material.uniforms.uInk.value;a?s.set(t.ink.r,t.ink.g,t.ink.b,.75):s.set(0,0,0,e.cavities?.12:.42),this.edges.material.uniforms.uFade.value=+!a;let c=!this.frame||this.frame.max<=this.frame.min;this.edges.material.uniforms.uByField.value=a&&e.coloring===`field`&&!c?1:0,this.edges.visible=n&&(a||e.edges);let l=this.ghost.material.uniforms;l.uInk.value.set(t.ink.r,t.ink.g,t.ink.b,.3),l.uFade.value=0,this.ghost.visible=n&&e.ghost;for(let t of this.sheets)t.visible=n&&e.symbols}box(e){if(!this.frame)return this.bounds.setFromArray(this.topology.rest);let t=new o().fromArray(this.frame.origin),n=t.clone().add(new o().fromArray(this.frame.scale));if(this.bounds.set(t,n),e!==1){this.bounds.makeEmpty();let t=new o,n=this.topology.rest.length/3;for(let r=0;r<n;r++)this.bounds.expandByPoint(this.place(r,e,t))}return this.bounds}place(e,t,n=new o){let{rest:r}=this.topology;n.set(r[3*e],r[3*e+1],r[3*e+2]);let i=this.frame;if(!i)return n;let a=i.packed,s=(n,r)=>r+t*(i.origin[n]+i.scale[n]*a[4*e+n]/65535-r);return n.set(s(0,n.x),s(1,n.y),s(2,n.z))}dispose(){this.lut.dispose();for(let e of this.geometries)e.dispose();for(let{mesh:e,stencils:t}of this.shells){e.material.dispose();for(let e of t)e.material.dispose()}this.edges.material.dispose(),this.ghost.material.dispose();for(let e of this.sheets)e.material.dispose()}},B=32,Oe=260,V=Math.PI/2-1e-4,H={front:[-Math.PI/2,0],back:[Math.PI/2,0],left:[Math.PI,0],right:[0,0],top:[-Math.PI/2,V],bottom:[-Math.PI/2,-V],corner:[-Math.PI/3.4,.42]},ke=class{perspective=new l(B,1,.001,10);orthographic=new ie(-1,1,1,-1,-10,10);pose={target:new o,azimuth:0,elevation:0,distance:.3};flight=null;width=1;height=1;reach=.1;flat=!1;steered=!1;places=0;constructor(){[this.pose.azimuth,this.pose.elevation]=H.corner,this.perspective.up.set(0,0,1),this.orthographic.up.set(0,0,1),this.place()}get camera(){return this.flat?this.orthographic:this.perspective}get target(){return this.pose.target}get toEye(){return Ae(this.pose.azimuth,this.pose.elevation)}get orientation(){return this.camera.quaternion}get pixelsPerMeter(){return this.height/(2*this.pose.distance*Math.tan(B*Math.PI/360))}resize(e,t){this.width=e,this.height=t,this.place()}setReach(e){this.reach=e,this.place()}turn(e,t){this.steered=!0,this.flight=null,this.pose.azimuth-=e*.0075,this.pose.elevation=je(this.pose.elevation+t*.0075),this.place()}move(e,t){this.steered=!0,this.flight=null;let n=1/this.pixelsPerMeter,r=new o(1,0,0).applyQuaternion(this.orientation),i=new o(0,1,0).applyQuaternion(this.orientation);this.pose.target.addScaledVector(r,-e*n).addScaledVector(i,t*n),this.place()}zoom(e,t,n){this.steered=!0,this.flight=null;let r=this.pose.distance,i=Math.min(100,Math.max(1e-4,r*e)),a=1/this.pixelsPerMeter,s=new o(1,0,0).applyQuaternion(this.orientation),c=new o(0,1,0).applyQuaternion(this.orientation),l=s.multiplyScalar(t*this.width*a/2).addScaledVector(c,n*this.height*a/2);this.pose.target.addScaledVector(l,1-i/r),this.pose.distance=i,this.place()}look(e){this.steered=!0;let[t,n]=H[e];this.fly({...this.pose,target:this.pose.target.clone(),azimuth:t,elevation:n})}turnAbout(e){this.steered=!0,this.fly({...this.pose,target:e.clone()})}closeTo(e,t){this.steered=!0;let n=t>0?Math.min(this.pose.distance,t):this.pose.distance;this.fly({...this.pose,target:e.clone(),distance:n})}fit(e,t=!1){if(e.isEmpty())return;this.steered=!1;let n=Math.max(1e-5,e.getSize(new o).length()/2),r=Math.min(1,this.width/this.height),i=1.12*n/Math.sin(B*Math.PI/360)/r,a={...this.pose,target:e.getCenter(new o),distance:i};t?(this.flight=null,this.pose=a,this.place()):this.fly(a)}holds(e){let t=new o;for(let n=0;n<8;n++)if(t.set((n&1?e.max:e.min).x,(n&2?e.max:e.min).y,(n&4?e.max:e.min).z),t.project(this.camera),Math.abs(t.x)>1||Math.abs(t.y)>1)return!1;return!0}advance(e){if(!this.flight)return!1;let{from:t,to:n,start:r}=this.flight,i=Math.min(1,(e-r)/Oe),a=1-(1-i)**3;return this.pose={target:t.target.clone().lerp(n.target,a),azimuth:t.azimuth+Me(t.azimuth,n.azimuth)*a,elevation:t.elevation+(n.elevation-t.elevation)*a,distance:t.distance*(n.distance/t.distance)**a},i===1&&(this.flight=null),this.place(),!0}fly(e){let t=matchMedia(`(prefers-reduced-motion: reduce)`).matches,n={...this.pose,target:this.pose.target.clone()};this.flight={from:n,to:e,start:t?-1/0:performance.now()}}place(){this.places+=1;let{target:e,distance:t}=this.pose,n=e.clone().addScaledVector(this.toEye,t),r=this.width/this.height,i=t+this.reach*12+.001;this.perspective.aspect=r,this.perspective.near=Math.max(t/200,t-this.reach*12),this.perspective.far=i;let a=t*Math.tan(B*Math.PI/360);this.orthographic.top=a,this.orthographic.bottom=-a,this.orthographic.left=-a*r,this.orthographic.right=a*r,this.orthographic.near=-i,this.orthographic.far=i;for(let t of[this.perspective,this.orthographic])t.position.copy(n),t.lookAt(e),t.updateProjectionMatrix(),t.updateMatrixWorld()}};function Ae(e,t){let n=Math.cos(t);return new o(n*Math.cos(e),n*Math.sin(e),Math.sin(t))}function je(e){return Math.min(V,Math.max(-V,e))}function Me(e,t){let n=2*Math.PI;return((t-e+Math.PI)%n+n)%n-Math.PI}var U=.99,Ne=.1,W=65536,Pe=new Set([0,1,2,3,8]),G=new WeakMap,K=new Float64Array(W);function Fe(e,t){let n={low:e.min,high:e.max,clipped:[]};if(e.max<=e.min||Pe.has(e.field))return n;let r=Ie(t);K.fill(0);let i=0;for(let t=0;t<r.length;t++)K[e.packed[4*t+3]]+=r[t],i+=r[t];if(i===0)return n;let a=J(e,q(.010000000000000009*i)),o=J(e,q(U*i)),s=Ne*(o-a),c={min:e.min<a-s,max:e.max>o+s},l=[];return c.max&&l.push(Y(e,t,`max`)),c.min&&l.push(Y(e,t,`min`)),{low:c.min?a:e.min,high:c.max?o:e.max,clipped:l}}function Ie(e){let t=G.get(e);if(t)return t;let{rest:n,triangles:r}=e,i=new Float64Array(n.length/3),a=(e,t,r)=>n[3*t+r]-n[3*e+r];for(let e=0;e<r.length;e+=3){let[t,n,o]=[r[e],r[e+1],r[e+2]],[s,c,l]=[a(t,n,0),a(t,n,1),a(t,n,2)],[u,d,f]=[a(t,o,0),a(t,o,1),a(t,o,2)],p=Math.hypot(c*f-l*d,l*u-s*f,s*d-c*u)/6;for(let e of[t,n,o])i[e]+=p}return G.set(e,i),i}function q(e){let t=0;for(let n=0;n<W;n++)if(t+=K[n],t>=e*(1-1e-9)&&t>0)return n;return 65535}function J(e,t){return e.min+(e.max-e.min)*t/65535}function Y(e,t,n){let r=n===`max`?1:-1,i=0;for(let t=1;4*t<e.packed.length;t++)r*(e.packed[4*t+3]-e.packed[4*i+3])>0&&(i=t);let{rest:a}=t,o=[a[3*i],a[3*i+1],a[3*i+2]];return{end:n,value:S(e,i),at:o}}function X(e){let t=getComputedStyle(document.documentElement).getPropertyValue(e).trim();return new d(t||`#888888`)}function Z(e){if(!(e>0))return 1;let t=10**Math.floor(Math.log10(e)+1e-9),n=e/t;return(n>=5?5:n>=2?2:1)*t}var Le=class{mesh=new _(new i(2,2),new c({glslVersion:f,vertexShader:F,fragmentShader:Se,depthTest:!1,depthWrite:!1,uniforms:{uTop:{value:X(`--sky-top`)},uBottom:{value:X(`--sky-bottom`)}}}));constructor(){this.mesh.frustumCulled=!1,this.mesh.renderOrder=-10}recolor(){this.mesh.material.uniforms.uTop.value=X(`--sky-top`),this.mesh.material.uniforms.uBottom.value=X(`--sky-bottom`)}},Re=class{cell=.01;mesh=new _(new i(1,1),new c({glslVersion:f,vertexShader:we,fragmentShader:Te,transparent:!0,depthWrite:!1,side:2,uniforms:{uCell:{value:.01},uCenter:{value:new a},uReach:{value:1},uInk:{value:X(`--grid`)},uFacing:{value:1}}}));constructor(){this.mesh.renderOrder=-5}recolor(){this.mesh.material.uniforms.uInk.value=X(`--grid`)}lay(e){let t=e.getSize(new o),n=e.getCenter(new o),r=Math.max(t.x,t.y,t.z);this.cell=Z(r/4);let{uCell:i,uCenter:a,uReach:s}=this.mesh.material.uniforms;i.value=this.cell,a.value.set(n.x,n.y),s.value=4.5*r,this.mesh.position.set(n.x,n.y,e.min.z-1e-4*r),this.mesh.scale.setScalar(9*r)}face(e){this.mesh.material.uniforms.uFacing.value=Math.min(1,Math.abs(e)/.12)}},ze=3,Be=9,Q=9,Ve=4;function $(e,t){return e.left<t.right&&t.left<e.right&&e.top<t.bottom&&t.top<e.bottom}function He(e,t){let n=[];return e.map(e=>{let r=n=>{let r=e.y-Be+21*n,i=t=>({left:e.x+Q-t,right:e.x+Q-t+e.width,top:r,bottom:r+18}),a=0;for(let e of t){let t=i(a);$(t,e)&&(a+=t.right-e.left+Ve)}return{rect:i(a),left:a}},i=e=>!n.some(t=>$(t,e));for(let e=0;e<=ze;e++){let{rect:t,left:a}=r(e);if(i(t))return n.push(t),{lines:e,left:a,crowded:!1}}if(e.minor)return{lines:0,left:0,crowded:!0};let{rect:a,left:o}=r(4);return n.push(a),{lines:4,left:o,crowded:!1}})}var Ue=class{element=document.createElement(`div`);shown=new Map;point=new o;constructor(){this.element.className=`view-labels`}set(e){let t=new Set(this.shown.keys());for(let n of e){t.delete(n.key);let e=this.shown.get(n.key)?.element;e&&e instanceof HTMLButtonElement!=!!n.onClick&&(e.remove(),e=void 0),e||(e=document.createElement(n.onClick?`button`:`span`),e.className=`view-label ${n.kind}`,e instanceof HTMLButtonElement&&(e.type=`button`),e.dataset.testid=`label-${n.key}`,this.element.append(e)),e.textContent!==n.text&&(e.textContent=n.text),n.title&&(e.title=`${n.text}\n${n.title}`),n.color&&e.style.setProperty(`--mark`,n.color),e.onclick=n.onClick??null,this.shown.set(n.key,{label:n,element:e})}for(let e of t)this.shown.get(e)?.element.remove(),this.shown.delete(e)}place(e,t,n,r=[]){let i=[];for(let{label:r,element:a}of this.shown.values()){let o=r.at(this.point).project(e),s=o.z>-1&&o.z<1&&Math.abs(o.x)<1.05&&Math.abs(o.y)<1.05;if(a.hidden=!s,!s)continue;let c=(o.x+1)/2*t,l=(1-o.y)/2*n,u=r.kind===`probe`;i.push({element:a,word:{x:c,y:l,width:7*r.text.length+24,minor:u}})}let a=He(i.map(e=>e.word),r);for(let[e,{element:t,word:n}]of i.entries()){let{lines:r,left:i,crowded:o}=a[e];t.classList.toggle(`crowded`,o),t.classList.toggle(`moved`,r>0&&i===0),t.style.setProperty(`--lead`,`${21*r}px`);let[s,c]=[Math.round(n.x-i),Math.round(n.y+21*r)];t.style.transform=`translate(${s}px, ${c}px)`}}};export{ge as C,S as D,ue as E,_e as S,ae as T,Ce as _,X as a,de as b,ke as c,z as d,L as f,k as g,be as h,Z as i,De as l,xe as m,Re as n,U as o,I as p,Le as r,Fe as s,Ue as t,R as u,A as v,y as w,he as x,F as y};