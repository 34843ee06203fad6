import{i as e}from"./studio.js";import{D as t,E as n,N as r,O as i,P as a,T as o,_ as s,n as c,r as l,v as u,w as d}from"./index.js";import{a as f,i as p,o as m,s as h}from"./recorder.js";import{A as g,C as _,D as v,E as y,F as b,M as x,N as S,O as C,P as w,S as T,T as E,_ as D,a as O,c as k,d as A,f as j,g as M,h as N,i as P,j as F,k as I,l as L,m as R,n as z,o as B,p as V,r as H,s as ee,t as te,u as ne,v as U,w as re,x as W,y as ie}from"./three.js";import{i as G}from"./colormaps.js";function ae(){let t=()=>$().drawn;Object.defineProperty(window,"voxsoft",{value:Object.freeze({get frame(){return t().frame},get time(){return t().time},get seq(){return t().seq},get latency(){return t().latency},get triangles(){return t().triangles},get topology(){return t().topology},get fps(){return t().fps},get state(){return e.getState().stat?.state??`empty`},get rev(){return e.getState().document?.rev??0},vertexPosition:e=>$().vertexPosition(e),screenOf:e=>$().screenOf(e)})})}var oe=class{newest=null;owed=[];offer(e){this.newest=e,this.owed.push(e.number)}take(e){let t=this.newest;this.newest=null;let n=this.owed;this.owed=[];for(let t of n)e(t);return t}clear(){this.newest=null,this.owed=[]}},se=`
in vec4 packed;
uniform vec3 uOrigin;
uniform vec3 uScale;
uniform float uExaggeration;
vec3 placed() {
  vec3 now = uOrigin + uScale * packed.xyz;
  return position + uExaggeration * (now - position);
}
`,ce=`
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
`,K=`
uniform vec4 uPlane;
uniform float uSection;
bool cutAway(vec3 at) {
  return uSection > 0.5 && dot(uPlane.xyz, at) > uPlane.w;
}
`,le=`
${se}
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
`,ue=`
precision highp float;
${K}
${ce}
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
  if (uByField > 0.5) {
    float share = shareOf(vField);
    base = colorOf(share);
    // Outside of a fixed range: stripes on the screen, seen without telling colors apart.
    float beyond = max(share - 1.0, -share);
    if (beyond > 0.01) {
      float stripe = step(0.5, fract((gl_FragCoord.x + gl_FragCoord.y) / 9.0));
      base = mix(base, vec3(share > 1.0 ? 1.0 : 0.15), 0.45 * stripe);
    }
  }
  color = vec4(base * light * (gl_FrontFacing ? 1.0 : 0.82), uAlpha);
}
`,de=`
precision highp float;
${K}
in vec3 vWorld;
out vec4 color;
void main() {
  if (cutAway(vWorld)) discard;
  color = vec4(0.0);
}
`,fe=`
${se}
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
`,pe=`
precision highp float;
${K}
${ce}
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
`,me=`
out vec3 vWorld;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vWorld = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}
`,he=`
precision highp float;
uniform vec3 uCut;
out vec4 color;
void main() {
  // Hatched, as drawings mark cut material.
  float line = smoothstep(0.0, 1.2, abs(fract((gl_FragCoord.x - gl_FragCoord.y) / 11.0) - 0.5) * 11.0 - 0.2);
  color = vec4(uCut * mix(0.82, 1.0, line), 1.0);
}
`,ge=`
out vec2 vAt;
void main() {
  vAt = position.xy * 0.5 + 0.5;
  gl_Position = vec4(position.xy, 1.0, 1.0);
}
`,_e=`
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
`,ve=`
out vec2 vAt;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vAt = world.xy;
  gl_Position = projectionMatrix * viewMatrix * world;
}
`,ye=`
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
`;function be(e,t,n){let r=r=>{let i=r===1?V:ne,a=new x({glslVersion:A,vertexShader:t,fragmentShader:de,uniforms:n,side:r,colorWrite:!1,depthWrite:!1,depthTest:!1,stencilWrite:!0,stencilFunc:519,stencilFail:i,stencilZFail:i,stencilZPass:i}),o=new W(e,a);return o.renderOrder=0,o.frustumCulled=!1,o.visible=!1,o};return[r(1),r(0)]}var q=[`#56b4e9`,`#e78ac3`,`#2fc39b`,`#e8dd55`,`#b9a2f5`,`#e8704a`],xe=128;function Se(e,t){let n=new Uint32Array(256);for(let e of t)n[e]+=1;let r=[],i=new Uint32Array(256),a=0;for(let e=0;e<256;e++){let t=n[e];i[e]=a,t>0&&r.push({owner:e,start:3*a,count:3*t}),a+=t}let o=new Uint32Array(e.length);for(let n=0;n<t.length;n++){let r=3*i[t[n]]++;o[r]=e[3*n],o[r+1]=e[3*n+1],o[r+2]=e[3*n+2]}return{index:o,ranges:r}}var Ce=class{group=new j;topology;frame=null;triangles=0;attribute;shells=[];edges;ghost;geometries=[];shared;lut;bounds=new z;constructor(e,t){this.topology=e;let n=e.rest.length/3,r=new H(e.rest,3);this.attribute=new H(new Uint16Array(4*n),4,!0),this.attribute.setUsage(35048),this.lut=new L(G(`viridis`,0),256,1),this.lut.minFilter=this.lut.magFilter=U,this.lut.needsUpdate=!0,this.shared={uOrigin:{value:new w},uScale:{value:new w},uExaggeration:{value:0},uPlane:t.plane,uSection:t.section,uLut:{value:this.lut},uFrameRange:{value:new S(0,1)},uRange:{value:new S(0,1)}};let{index:i,ranges:a}=Se(e.triangles,e.owners),o=new H(i,1);for(let e of a)this.shells.push(this.shell(r,o,e));this.edges=this.lines(r,this.shared),this.edges.renderOrder=4,this.ghost=this.lines(r,{...this.shared,uExaggeration:{value:0}}),this.ghost.renderOrder=3,this.group.add(this.edges,this.ghost)}geometry(e,t){let n=new P;return n.setAttribute(`position`,e),n.setAttribute(`packed`,this.attribute),n.setIndex(t),this.geometries.push(n),n}shell(e,t,n){let r=this.geometry(e,t);r.setDrawRange(n.start,n.count);let i=new x({glslVersion:A,vertexShader:le,fragmentShader:ue,side:2,polygonOffset:!0,polygonOffsetFactor:1,polygonOffsetUnits:1,uniforms:{...this.shared,uByField:{value:1},uOwn:{value:new O(`#e8b88a`)},uAlpha:{value:1}}}),a=new W(r,i);a.renderOrder=2,a.frustumCulled=!1;let o=[...be(r,le,this.shared)];return this.group.add(a,...o),{owner:n.owner,mesh:a,stencils:o}}lines(e,t){let n=this.geometry(e,new H(this.topology.edges,1)),r=new x({glslVersion:A,vertexShader:fe,fragmentShader:pe,transparent:!0,depthWrite:!1,uniforms:{...t,uVoxelSize:{value:this.topology.voxelSize||1},uPixels:{value:1},uFade:{value:1},uByField:{value:0},uInk:{value:new b(0,0,0,.4)}}}),i=new D(n,r);return i.frustumCulled=!1,i}suits(e){return e.topology===this.topology.id&&e.packed.length===this.attribute.array.length}setFrame(e){this.frame=e,this.attribute.array=e.packed,this.attribute.needsUpdate=!0,this.shared.uOrigin.value.fromArray(e.origin),this.shared.uScale.value.fromArray(e.scale),this.shared.uFrameRange.value.set(e.min,e.max)}setRange(e,t){this.shared.uRange.value.set(e,t)}setPixels(e){this.edges.material.uniforms.uPixels.value=e,this.ghost.material.uniforms.uPixels.value=e}lutKey=``;style(e,t,n){let r=`${e.colormap} ${e.bands}`;r!==this.lutKey&&(this.lutKey=r,this.lut.image.data.set(G(e.colormap,e.bands)),this.lut.minFilter=this.lut.magFilter=U,this.lut.needsUpdate=!0),this.shared.uExaggeration.value=this.frame?e.exaggeration:0;let i=e.appearance===`wireframe`,a=e.section!==`off`;this.triangles=0;for(let{owner:r,mesh:o,stencils:s}of this.shells){let c=(r&xe)!==0,{uniforms:l}=o.material,u=e.cavities&&!c,d=!this.frame||this.frame.max<=this.frame.min,f=e.coloring===`field`&&!d&&!(e.cavities&&c);l.uByField.value=+!!f,l.uAlpha.value=u?.16:1;let p=c?e.cavities?q[(r&127)%q.length]:t.parts[0]??`#e8b88a`:t.parts[r]??`#e8b88a`;l.uOwn.value.set(p),o.material.transparent!==u&&(o.material.transparent=u,o.material.depthWrite=!u,o.material.needsUpdate=!0),o.renderOrder=u?5:2,o.visible=n&&!i,o.visible&&(this.triangles+=o.geometry.drawRange.count/3);for(let e of s)e.visible=o.visible&&a&&!this.topology.tets}let o=this.edges.material.uniforms.uInk.value;i?o.set(t.ink.r,t.ink.g,t.ink.b,.75):o.set(0,0,0,e.cavities?.12:.42),this.edges.material.uniforms.uFade.value=+!i;let s=!this.frame||this.frame.max<=this.frame.min;this.edges.material.uniforms.uByField.value=i&&e.coloring===`field`&&!s?1:0,this.edges.visible=n&&(i||e.edges);let c=this.ghost.material.uniforms;c.uInk.value.set(t.ink.r,t.ink.g,t.ink.b,.3),c.uFade.value=0,this.ghost.visible=n&&e.ghost}box(e){if(!this.frame)return this.bounds.setFromArray(this.topology.rest);let t=new w().fromArray(this.frame.origin),n=t.clone().add(new w().fromArray(this.frame.scale));if(this.bounds.set(t,n),e!==1){this.bounds.makeEmpty();let t=new w,n=this.topology.rest.length/3;for(let r=0;r<n;r++)this.bounds.expandByPoint(this.place(r,e,t))}return this.bounds}place(e,t,n=new w){let{rest:r}=this.topology;n.set(r[3*e],r[3*e+1],r[3*e+2]);let i=this.frame;if(!i)return n;let a=i.packed,o=(n,r)=>r+t*(i.origin[n]+i.scale[n]*a[4*e+n]/65535-r);return n.set(o(0,n.x),o(1,n.y),o(2,n.z))}dispose(){this.lut.dispose();for(let e of this.geometries)e.dispose();for(let{mesh:e,stencils:t}of this.shells){e.material.dispose();for(let e of t)e.material.dispose()}this.edges.material.dispose(),this.ghost.material.dispose()}},J=32,we=260,Y=Math.PI/2-1e-4,Te={front:[-Math.PI/2,0],back:[Math.PI/2,0],left:[Math.PI,0],right:[0,0],top:[-Math.PI/2,Y],bottom:[-Math.PI/2,-Y],corner:[-Math.PI/3.4,.42]},Ee=class{perspective=new re(J,1,.001,10);orthographic=new _(-1,1,1,-1,-10,10);pose={target:new w,azimuth:0,elevation:0,distance:.3};flight=null;width=1;height=1;reach=.1;flat=!1;constructor(){[this.pose.azimuth,this.pose.elevation]=Te.corner,this.perspective.up.set(0,0,1),this.orthographic.up.set(0,0,1),this.place()}get camera(){return this.flat?this.orthographic:this.perspective}get target(){return this.pose.target}get toEye(){return De(this.pose.azimuth,this.pose.elevation)}get orientation(){return this.camera.quaternion}get pixelsPerMeter(){return this.height/(2*this.pose.distance*Math.tan(J*Math.PI/360))}resize(e,t){this.width=e,this.height=t,this.place()}setReach(e){this.reach=e,this.place()}turn(e,t){this.flight=null,this.pose.azimuth-=e*.0075,this.pose.elevation=Oe(this.pose.elevation+t*.0075),this.place()}move(e,t){this.flight=null;let n=1/this.pixelsPerMeter,r=new w(1,0,0).applyQuaternion(this.orientation),i=new w(0,1,0).applyQuaternion(this.orientation);this.pose.target.addScaledVector(r,-e*n).addScaledVector(i,t*n),this.place()}zoom(e,t,n){this.flight=null;let r=this.pose.distance,i=Math.min(100,Math.max(1e-4,r*e)),a=1/this.pixelsPerMeter,o=new w(1,0,0).applyQuaternion(this.orientation),s=new w(0,1,0).applyQuaternion(this.orientation),c=o.multiplyScalar(t*this.width*a/2).addScaledVector(s,n*this.height*a/2);this.pose.target.addScaledVector(c,1-i/r),this.pose.distance=i,this.place()}look(e){let[t,n]=Te[e];this.fly({...this.pose,target:this.pose.target.clone(),azimuth:t,elevation:n})}turnAbout(e){this.fly({...this.pose,target:e.clone()})}fit(e,t=!1){if(e.isEmpty())return;let n=Math.max(1e-5,e.getSize(new w).length()/2),r=Math.min(1,this.width/this.height),i=1.12*n/Math.sin(J*Math.PI/360)/r,a={...this.pose,target:e.getCenter(new w),distance:i};t?(this.flight=null,this.pose=a,this.place()):this.fly(a)}advance(e){if(!this.flight)return!1;let{from:t,to:n,start:r}=this.flight,i=Math.min(1,(e-r)/we),a=1-(1-i)**3;return this.pose={target:t.target.clone().lerp(n.target,a),azimuth:t.azimuth+ke(t.azimuth,n.azimuth)*a,elevation:t.elevation+(n.elevation-t.elevation)*a,distance:t.distance*(n.distance/t.distance)**a},i===1&&(this.flight=null),this.place(),!0}fly(e){let t=matchMedia(`(prefers-reduced-motion: reduce)`).matches,n={...this.pose,target:this.pose.target.clone()};this.flight={from:n,to:e,start:t?-1/0:performance.now()}}place(){let{target:e,distance:t}=this.pose,n=e.clone().addScaledVector(this.toEye,t),r=this.width/this.height,i=t+this.reach*12+.001;this.perspective.aspect=r,this.perspective.near=Math.max(t/200,t-this.reach*12),this.perspective.far=i;let a=t*Math.tan(J*Math.PI/360);this.orthographic.top=a,this.orthographic.bottom=-a,this.orthographic.left=-a*r,this.orthographic.right=a*r,this.orthographic.near=-i,this.orthographic.far=i;for(let t of[this.perspective,this.orthographic])t.position.copy(n),t.lookAt(e),t.updateProjectionMatrix(),t.updateMatrixWorld()}};function De(e,t){let n=Math.cos(t);return new w(n*Math.cos(e),n*Math.sin(e),Math.sin(t))}function Oe(e){return Math.min(Y,Math.max(-Y,e))}function ke(e,t){let n=2*Math.PI;return((t-e+Math.PI)%n+n)%n-Math.PI}var Ae=`#f2a33a`,je=class{group=new j;pulls=new Map;held=null;plane=new E;nextId=1;sent=null;get holding(){return this.held!==null}begin(e,t,n){let r=h.getState().stiffness,i=new R(new P().setAttribute(`position`,new H(new Float32Array(6),3)),new N({color:new O(Ae),depthTest:!1,transparent:!0}));i.frustumCulled=!1,i.renderOrder=8,this.group.add(i),this.held={id:this.nextId++,vertex:e,target:t.clone(),stiffness:r,line:i},this.pulls.set(this.held.id,this.held),this.plane.setFromNormalAndCoplanarPoint(n,t),this.tell(this.held)}move(e){this.held&&e.intersectPlane(this.plane,this.held.target)}deeper(e,t){this.held&&(this.plane.constant+=e,this.move(t))}flush(){this.held&&!(this.sent?.equals(this.held.target)??!1)&&this.tell(this.held)}tell(e){let{id:n,vertex:r,target:i,stiffness:a}=e;t({t:`grab`,id:n,vertex:r,target:[i.x,i.y,i.z],stiffness:a}),this.sent=i.clone()}end(e){this.held&&(this.flush(),e||this.release(this.held.id),this.held=null,this.sent=null)}release(e){let n=this.pulls.get(e);n&&(this.pulls.delete(e),n.line.removeFromParent(),n.line.geometry.dispose(),n.line.material.dispose(),t({t:`release`,id:e}))}forgetPinned(){for(let[e,t]of this.pulls)t!==this.held&&(t.line.removeFromParent(),this.pulls.delete(e))}clear(){for(let e of this.pulls.values())e.line.removeFromParent();this.pulls.clear(),this.held=null,this.sent=null}update(t){let n=e.getState().stat?.grabs??[],r=[],i=new w;for(let e of this.pulls.values()){t.place(e.vertex,1,i);let a=e.line.geometry.getAttribute(`position`);a.setXYZ(0,i.x,i.y,i.z),a.setXYZ(1,e.target.x,e.target.y,e.target.z),a.needsUpdate=!0;let o=n.find(t=>t.id===e.id),s=o?Math.hypot(...o.force):e.stiffness*i.distanceTo(e.target),l=t.topology.rest,u=Math.hypot(i.x-l[3*e.vertex],i.y-l[3*e.vertex+1],i.z-l[3*e.vertex+2]);r.push({key:`force-${e.id}`,kind:`force`,text:`${c(s,3)} N · moved ${c(u*1e3,3)} mm`,title:e===this.held?``:`Take this spring away`,at:t=>t.copy(e.target),...e===this.held?{}:{onClick:()=>this.release(e.id)}})}return r}};function X(e){let t=getComputedStyle(document.documentElement).getPropertyValue(e).trim();return new O(t||`#888888`)}function Me(e){if(!(e>0))return 1;let t=10**Math.floor(Math.log10(e)+1e-9),n=e/t;return(n>=5?5:n>=2?2:1)*t}var Ne=class{mesh=new W(new y(2,2),new x({glslVersion:A,vertexShader:ge,fragmentShader:_e,depthTest:!1,depthWrite:!1,uniforms:{uTop:{value:X(`--sky-top`)},uBottom:{value:X(`--sky-bottom`)}}}));constructor(){this.mesh.frustumCulled=!1,this.mesh.renderOrder=-10}recolor(){this.mesh.material.uniforms.uTop.value=X(`--sky-top`),this.mesh.material.uniforms.uBottom.value=X(`--sky-bottom`)}},Pe=class{cell=.01;mesh=new W(new y(1,1),new x({glslVersion:A,vertexShader:ve,fragmentShader:ye,transparent:!0,depthWrite:!1,side:2,uniforms:{uCell:{value:.01},uCenter:{value:new S},uReach:{value:1},uInk:{value:X(`--grid`)},uFacing:{value:1}}}));constructor(){this.mesh.renderOrder=-5}recolor(){this.mesh.material.uniforms.uInk.value=X(`--grid`)}lay(e){let t=e.getSize(new w),n=e.getCenter(new w),r=Math.max(t.x,t.y,t.z);this.cell=Me(r/4);let{uCell:i,uCenter:a,uReach:o}=this.mesh.material.uniforms;i.value=this.cell,a.value.set(n.x,n.y),o.value=4.5*r,this.mesh.position.set(n.x,n.y,e.min.z-1e-4*r),this.mesh.scale.setScalar(9*r)}face(e){this.mesh.material.uniforms.uFacing.value=Math.min(1,Math.abs(e)/.12)}},Fe=class{element=document.createElement(`div`);shown=new Map;point=new w;constructor(){this.element.className=`view-labels`}set(e){let t=new Set(this.shown.keys());for(let n of e){t.delete(n.key);let e=this.shown.get(n.key)?.element;e&&e instanceof HTMLButtonElement!=!!n.onClick&&(e.remove(),e=void 0),e||(e=document.createElement(n.onClick?`button`:`span`),e.className=`view-label ${n.kind}`,e instanceof HTMLButtonElement&&(e.type=`button`),e.dataset.testid=`label-${n.key}`,this.element.append(e)),e.textContent!==n.text&&(e.textContent=n.text),n.title&&(e.title=n.title),n.color&&e.style.setProperty(`--mark`,n.color),e.onclick=n.onClick??null,this.shown.set(n.key,{label:n,element:e})}for(let e of t)this.shown.get(e)?.element.remove(),this.shown.delete(e)}place(e,t,n){let r=[];for(let{label:i,element:a}of this.shown.values()){let o=i.at(this.point).project(e),s=o.z>-1&&o.z<1&&Math.abs(o.x)<1.05&&Math.abs(o.y)<1.05;if(a.hidden=!s,!s)continue;let c=(o.x+1)/2*t,l=(1-o.y)/2*n,u=7*i.text.length+24;for(;r.some(e=>Math.abs(e.y-l)<20&&Math.abs(e.x-c)<(e.w+u)/2);)l+=21;r.push({x:c,y:l,w:u}),a.style.transform=`translate(${c.toFixed(1)}px, ${l.toFixed(1)}px)`}}};function Ie(e,t,n,r=()=>!0){let{x:i,y:a,z:o}=e.origin,{x:s,y:c,z:l}=e.direction,u=1/0,d=-1,[f,p]=[0,0],m=new w;for(let h=0;h<n.length;h+=3){let g=3*n[h],_=3*n[h+1],v=3*n[h+2],y=t[g],b=t[g+1],x=t[g+2],S=t[_]-y,C=t[_+1]-b,w=t[_+2]-x,T=t[v]-y,E=t[v+1]-b,D=t[v+2]-x,O=c*D-l*E,k=l*T-s*D,A=s*E-c*T,j=S*O+C*k+w*A;if(j===0)continue;let M=1/j,N=i-y,P=a-b,F=o-x,I=(N*O+P*k+F*A)*M;if(I<-1e-9||I>1.000000001)continue;let L=P*w-F*C,R=F*S-N*w,z=N*C-P*S,B=(s*L+c*R+l*z)*M;if(B<-1e-9||I+B>1.000000001)continue;let V=(T*L+E*R+D*z)*M;V<=0||V>=u||r(e.at(V,m))&&(u=V,d=h,[f,p]=[I,B])}if(d<0)return null;let h=[n[d],n[d+1],n[d+2]],g=[1-f-p,f,p];return{vertex:h[g.indexOf(Math.max(...g))],triangle:h,weights:g,point:e.at(u,new w),distance:u}}var Le=4;function Re(n){let r=n.renderer.domElement,i=null,a={x:0,y:0},o={x:0,y:0};r.addEventListener(`pointerdown`,e=>{r.focus({preventScroll:!0}),r.setPointerCapture(e.pointerId),a=o={x:e.clientX,y:e.clientY};let t=e.button===0&&!e.altKey?n.hit(e.clientX,e.clientY):null;i=e.button===1||e.button===0&&e.shiftKey&&!t?{kind:`move`}:t?{kind:`maybe-pull`,hit:t}:{kind:`turn`},e.preventDefault()}),r.addEventListener(`pointermove`,s=>{let[c,l]=[s.clientX-o.x,s.clientY-o.y];if(o={x:s.clientX,y:s.clientY},!i)n.hoverOver({x:s.clientX,y:s.clientY});else{if(i.kind===`turn`)n.rig.turn(c,l);else if(i.kind===`move`)n.rig.move(c,l);else if(i.kind===`maybe-pull`){if(Math.hypot(s.clientX-a.x,s.clientY-a.y)<Le)return;if(ze()){let a=n.shownMesh();a&&n.grabs.begin(i.hit.vertex,a.place(i.hit.vertex,1),n.rig.toEye),n.grabs.move(n.ray(s.clientX,s.clientY)),i={kind:`pull`},n.hoverOver(null),r.style.cursor=`grabbing`,e.getState().stat?.state!==`playing`&&t({t:`play`})}else i={kind:`turn`}}else n.grabs.move(n.ray(s.clientX,s.clientY));n.request()}});let s=e=>{i?.kind===`pull`?n.grabs.end(e.shiftKey):i?.kind===`maybe-pull`&&Be(n,i.hit),i=null,r.style.cursor=``,n.request()};r.addEventListener(`pointerup`,s),r.addEventListener(`pointercancel`,s),r.addEventListener(`pointerleave`,()=>{i||n.hoverOver(null)}),r.addEventListener(`contextmenu`,e=>e.preventDefault()),r.addEventListener(`wheel`,e=>{e.preventDefault();let t=e.deltaMode===1?e.deltaY/3:e.deltaY/100;if(n.grabs.holding){let i=-t*.02*(r.clientHeight/n.rig.pixelsPerMeter);n.grabs.deeper(i,n.ray(e.clientX,e.clientY))}else{let i=r.getBoundingClientRect(),a=(e.clientX-i.left)/i.width*2-1,o=1-(e.clientY-i.top)/i.height*2;n.rig.zoom(1.12**t,a,o)}n.request()},{passive:!1}),r.addEventListener(`dblclick`,e=>{let t=n.hit(e.clientX,e.clientY);t&&n.rig.turnAbout(t.point),n.request()}),addEventListener(`keydown`,e=>{e.key===`Escape`&&(n.grabs.holding?(n.grabs.end(!1),i=null):h.getState().tape&&f({tape:!1}),n.request())})}function ze(){let t=e.getState().stat?.state,n=h.getState();return(t===`playing`||t===`paused`||t===`at-rest`)&&!n.tape&&n.exaggeration===1&&n.appearance!==`smooth`}function Be(e,n){h.getState().tape?e.tape.add(n):t({t:`pick`,vertex:n.vertex})}var Ve={x:new w(1,0,0),y:new w(0,1,0),z:new w(0,0,1)},He=class{group=new j;plane={value:new b(0,0,1,0)};on={value:0};cap;outline;constructor(){this.cap=new W(new y(1,1),new x({glslVersion:A,vertexShader:me,fragmentShader:he,side:2,uniforms:{uCut:{value:X(`--cut`)}},stencilWrite:!0,stencilRef:0,stencilFunc:517,stencilFail:g,stencilZFail:g,stencilZPass:g})),this.cap.renderOrder=1;let e=[[-.5,-.5],[.5,-.5],[.5,.5],[-.5,.5]].map(([e,t])=>new w(e,t,0));this.outline=new M(new P().setFromPoints(e),new N({transparent:!0,opacity:.5})),this.outline.renderOrder=6,this.group.add(this.cap,this.outline),this.group.visible=!1,this.recolor()}recolor(){this.cap.material.uniforms.uCut.value=X(`--cut`),this.outline.material.color=X(`--accent`)}keeps(e){let{x:t,y:n,z:r,w:i}=this.plane.value;return this.on.value===0||t*e.x+n*e.y+r*e.z<=i}update(e,t,n){if(this.on.value=e.section===`off`||t.isEmpty()?0:1,this.group.visible=this.on.value===1,e.section===`off`)return;let r=t.getSize(new w),i=t.getCenter(new w),a=Ve[e.section],o=Math.min(.9995,Math.max(5e-4,e.sectionAt)),s=t.min.dot(a)+o*r.dot(a),c=e.sectionFlipped?-1:1;this.plane.value.set(c*a.x,c*a.y,c*a.z,c*s);let l=i.clone().addScaledVector(a,s-i.dot(a));for(let e of[this.cap,this.outline]){e.position.copy(l),e.quaternion.setFromUnitVectors(Ve.z,a);let t=e===this.cap?6:1.25,n=Math.max(r.x,r.y,r.z);e.scale.setScalar(n*t)}this.cap.visible=n}},Ue=`
out vec3 vNormal;
out vec3 vWorld;
void main() {
  vWorld = position;
  vNormal = normalMatrix * normal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`,We=`
precision highp float;
in vec3 vNormal;
in vec3 vWorld;
uniform vec3 uOwn;
uniform vec4 uPlane;
uniform float uSection;
out vec4 color;
void main() {
  if (uSection > 0.5 && dot(uPlane.xyz, vWorld) > uPlane.w) discard;
  vec3 normal = normalize(vNormal);
  if (!gl_FrontFacing) normal = -normal;
  float key = max(0.0, dot(normal, normalize(vec3(0.35, 0.55, 0.75))));
  float rim = pow(1.0 - max(0.0, normal.z), 3.0);
  vec3 base = gl_FrontFacing ? uOwn : uOwn * 0.55;
  color = vec4(base * (0.58 + 0.46 * key) + 0.10 * rim, 1.0);
}
`,Ge=class{group=new j;geometry=new P;material;stencils;constructor(e,t){this.geometry.setAttribute(`position`,new H(e.vertices,3)),this.geometry.setIndex(new H(e.triangles,1)),this.geometry.computeVertexNormals(),this.material=new x({glslVersion:A,vertexShader:Ue,fragmentShader:We,side:2,uniforms:{uPlane:t.plane,uSection:t.section,uOwn:{value:new O(`#e8b88a`)}}});let n=new W(this.geometry,this.material);n.frustumCulled=!1,n.renderOrder=2;let{uPlane:r,uSection:i}=this.material.uniforms;this.stencils=be(this.geometry,Ue,{uPlane:r,uSection:i}),this.group.add(n,...this.stencils)}style(e,t,n){this.material.uniforms.uOwn.value.set(t.parts[0]??`#e8b88a`),this.group.visible=n;for(let t of this.stencils)t.visible=e.section!==`off`}dispose(){this.group.removeFromParent(),this.geometry.dispose(),this.material.dispose();for(let e of this.stencils)e.material.dispose()}},Ke=`#98a1ab`,qe=`#e8704a`,Je=`#56b4e9`;function Ye(e,t){let n=t?.loads[e.index]??e.value;return`${c(n/e.factor,3)} ${e.unit}`.trim()}var Xe=class{group=new j;disposables=[];build(e){this.clear();let t=Math.hypot(...e.bounds[1].map((t,n)=>t-(e.bounds[0][n]??0)));for(let t of e.clamps)this.points(t.points.flat(),Ke,5);for(let n of e.loads){let e=new w(...n.direction);n.kind!==`pressure`&&e.lengthSq()>0&&this.arrow(new w(...n.at),e.normalize(),.16*t)}}points(e,t,n){let r=new P;r.setAttribute(`position`,new H(new Float32Array(e),3));let i=new C({color:new O(t),size:n,sizeAttenuation:!1,transparent:!0,opacity:.9,depthWrite:!1}),a=new v(r,i);a.renderOrder=6,this.group.add(a),this.disposables.push(r,i)}arrow(e,t,n){let r=.28*n,i=new T({color:new O(qe)}),a=new k(.028*n,.028*n,n-r,12);a.translate(0,-(r+(n-r)/2),0);let o=new ee(.1*n,r,20);o.translate(0,-r/2,0);for(let n of[a,o]){let r=new W(n,i);r.quaternion.setFromUnitVectors(new w(0,1,0),t),r.position.copy(e),r.renderOrder=6,this.group.add(r)}this.disposables.push(i,a,o)}clear(){this.group.clear();for(let e of this.disposables)e.dispose();this.disposables=[]}labels(e,t,n,r,i){let a=[],o=e=>t=>t.set(e[0]??0,e[1]??0,e[2]??0);for(let[t,n]of e.clamps.entries())a.push({key:`clamp-${t}`,kind:`clamp`,text:n.name,title:`${n.vertices} vertices are held`,color:Ke,at:o(n.center),onClick:()=>u(`design`)});for(let n of e.loads)a.push({key:`load-${n.index}`,kind:`load`,text:`${n.label} ${Ye(n,t)}`,title:`Change this load`,color:qe,at:o(n.at),onClick:()=>u(`run`)});for(let t of e.probes)a.push({key:`probe-${t.name}`,kind:`probe`,text:t.name,title:`Show what this probe measured`,color:Je,at:e=>{if(!n||n.topology.tets||t.vertices.length===0)return o(t.center)(e);let i=new w;e.set(0,0,0);for(let a of t.vertices)e.add(n.place(a,r,i));return e.divideScalar(t.vertices.length)},onClick:()=>u(`probes`)});if(i)for(let[t,n]of e.cavities.entries())a.push({key:`cavity-${t}`,kind:`cavity`,text:`cavity ${t+1} · ${l(n.volume,`m^3`,3)}${n.leaks?` · leaks`:``}`,color:q[t%q.length],at:o(n.center)});for(let[t,n]of e.leaks.entries())a.push({key:`leak-${t}`,kind:`leak`,text:`open here: ${l(n.volume,`m^3`,3)} is not enclosed`,at:o(n.point)});return a}},Ze=class{group=new j;anchors=[];geometry=new P;constructor(){this.geometry.setAttribute(`position`,new H(new Float32Array(6),3));let e={color:new O(`#e8dd55`),depthTest:!1,transparent:!0},t=new R(this.geometry,new N(e)),n=new v(this.geometry,new C({...e,size:8,sizeAttenuation:!1}));for(let e of[t,n])e.frustumCulled=!1,e.renderOrder=8,this.group.add(e);this.group.visible=!1}add(e){this.anchors.length>=2&&(this.anchors=[]),this.anchors.push({triangle:e.triangle,weights:e.weights})}clear(){this.anchors=[]}update(e,t){if(this.group.visible=this.anchors.length>0,!this.group.visible)return{length:null,labels:[]};let n=this.geometry.getAttribute(`position`),[r=new w,i=r]=this.anchors.map(n=>Qe(e,n,t));if(n.setXYZ(0,r.x,r.y,r.z),n.setXYZ(1,i.x,i.y,i.z),n.needsUpdate=!0,this.anchors.length<2)return{length:null,labels:[]};let[a,o]=this.anchors.map(t=>Qe(e,t,1)),s=a.distanceTo(o),c=r.clone().add(i).multiplyScalar(.5);return{length:s,labels:[{key:`tape`,kind:`tape`,text:l(s,`m`,4),at:e=>e.copy(c)}]}}};function Qe(e,t,n){let r=new w,i=new w;for(let[a,o]of t.triangle.entries())r.addScaledVector(e.place(o,n,i),t.weights[a]);return r}B.enabled=!1;var Z=120,$e=100;function et(e){return e&&`${e.path} ${e.name}`}var tt=class{element=document.createElement(`div`);rig=new Ee;grabs=new je;tape=new Ze;renderer;scene=new F;sky=new Ne;ground=new Pe;section=new He;symbols=new Xe;labels=new Fe;ink=X(`--ink`);gate=new oe;raycaster=new I;surface=null;tets=null;smooth=null;latest=null;positions=null;asked=null;attached=!1;lastTold=0;tellTimer=null;lastHover=0;hoverAt=null;times=[];latency=null;lastSeq=0;extremes=null;fitNext=!0;documentName=et(e.getState().document);drawnListeners=new Set;constructor(){this.element.className=`viewport`,this.renderer=new te({antialias:!0,stencil:!0}),this.renderer.outputColorSpace=ie,this.renderer.setPixelRatio(Math.min(2,devicePixelRatio)),this.renderer.info.autoReset=!0,this.renderer.domElement.setAttribute(`aria-label`,`The body`),this.renderer.domElement.tabIndex=0,this.element.append(this.renderer.domElement,this.labels.element),this.scene.add(this.sky.mesh,this.ground.mesh,this.section.group,this.symbols.group,this.grabs.group,this.tape.group),new ResizeObserver(()=>this.resize()).observe(this.element),new MutationObserver(()=>this.recolor()).observe(document.documentElement,{attributeFilter:[`data-theme`]}),Re(this),h.subscribe((e,t)=>this.viewChanged(e,t)),e.subscribe((e,t)=>{e.body!==t.body&&this.bodyChanged(),e.stat!==t.stat&&(e.stat?.grabs.length===0&&t.stat?.grabs.length&&this.grabs.forgetPinned(),this.request());let n=et(e.document);n!==null&&n!==this.documentName&&(this.documentName=n,this.fitNext=!0)}),document.addEventListener(`visibilitychange`,()=>this.tellView()),o(()=>{this.gate.clear(),this.tellView()}),n(this),e.getState().body&&this.bodyChanged()}topology(e){let t=(this.surface??this.tets)?.topology.id!==e.id;if(!t&&!e.tets&&this.surface)return;let n=new Ce(e,{plane:this.section.plane,section:this.section.on});t&&this.clearBody(n.box(1)),e.tets?(this.drop(this.tets),this.tets=n):this.surface=n,this.scene.add(n.group),this.request()}clearBody(e){this.drop(this.surface),this.drop(this.tets),this.surface=this.tets=null,this.smooth?.dispose(),this.smooth=null,this.latest=null,this.extremes=null,this.positions=null,this.grabs.clear(),this.tape.clear(),this.ground.lay(e),this.rig.setReach(e.getSize(new w).length()||.1),this.fitNext&&this.rig.fit(e,!0),this.fitNext=!1}frame(e){this.gate.offer(e),this.request()}smoothSurface(e){this.smooth?.dispose(),this.smooth=new Ge(e,{plane:this.section.plane,section:this.section.on}),this.scene.add(this.smooth.group),this.request()}drop(e){e&&(e.group.removeFromParent(),e.dispose())}bodyChanged(){let t=e.getState().body;t?this.symbols.build(t):this.symbols.clear(),this.request()}viewChanged(e,t){let n=e=>e.appearance===`tets`?`tets`:`surface`;(e.field!==t.field||n(e)!==n(t))&&this.tellView(),!e.tape&&t.tape&&this.tape.clear(),this.rig.flat=e.orthographic,this.request()}tellView(){let e=h.getState(),n=this.attached&&document.visibilityState===`visible`;d()&&t({t:`view`,field:e.field,mode:e.appearance===`tets`?`tets`:`surface`,visible:n})}attach(e){e.prepend(this.element),this.attached=!0,this.resize(),this.tellView()}detach(){this.element.remove(),this.attached=!1,this.tellView()}resize(){let{clientWidth:e,clientHeight:t}=this.element;e<2||t<2||(this.renderer.setSize(e,t),this.rig.resize(e,t),this.request())}recolor(){this.ink=X(`--ink`),this.sky.recolor(),this.ground.recolor(),this.section.recolor(),this.request()}request(){this.asked===null&&this.attached&&(this.asked=requestAnimationFrame(e=>{this.asked=null,this.draw(e)}))}onDrawn(e){return this.drawnListeners.add(e),()=>this.drawnListeners.delete(e)}draw(e){this.takeFrame(e),this.rig.advance(e)&&this.request(),this.grabs.flush();let t=h.getState(),n=this.shownMesh();this.style(t,n);let r=this.words(t,n);this.ground.face(this.rig.toEye.z),this.renderer.render(this.scene,this.rig.camera),this.labels.element.classList.toggle(`passive`,t.tape||this.grabs.holding),this.labels.set(r),this.labels.place(this.rig.camera,this.element.clientWidth,this.element.clientHeight),this.hover(e,t),this.tell(e,t);for(let e of this.drawnListeners)e()}takeFrame(e){let t=this.gate.take(e=>d()?.acknowledge(e));if(!t)return;let n=(h.getState().appearance===`tets`?[this.tets,this.surface]:[this.surface,this.tets]).find(e=>e?.suits(t));n&&(n.setFrame(t),this.latest=t,this.extremes=null,this.times.push(e),t.seq>this.lastSeq&&(this.lastSeq=t.seq,this.latency=i(t.seq)??this.latency))}shownMesh(){return h.getState().appearance===`tets`&&this.tets?.frame?this.tets:this.surface}style(t,n){let r={parts:e.getState().body?.parts.map(e=>e.color)??[],ink:this.ink},i=t.appearance===`smooth`&&this.smooth!==null,[a,o]=this.range(t);for(let e of[this.surface,this.tets])e?.setRange(a,o),e?.setPixels(this.renderer.domElement.height/2),e?.style(t,r,e===n&&!i);this.smooth?.style(t,r,i);let s=n?.box(t.exaggeration)??new z;this.section.update(t,s,t.appearance!==`wireframe`&&!t.cavities&&!n?.topology.tets),this.ground.mesh.visible=t.grid&&n!==null,this.symbols.group.visible=t.symbols}range(e){if(e.range===`locked`)return[e.low,e.high];let t=this.latest;if(!t)return[0,1];if(e.range===`auto`)return[t.min,t.max];let n=Math.max(Math.abs(t.min),Math.abs(t.max));return[-n,n]}words(t,n){if(!n)return[];let{body:r,stat:i}=e.getState(),a=[];r&&t.symbols&&a.push(...this.symbols.labels(r,i,n,t.exaggeration,t.cavities)),t.extremes&&n.frame&&t.coloring===`field`&&a.push(...this.extremeWords(n,t));let o=this.surface;o&&a.push(...this.grabs.update(o));let s=o?this.tape.update(o,t.exaggeration):null;return s&&a.push(...s.labels),s&&s.length!==m.getState().tapeLength&&m.setState({tapeLength:s.length}),a}extremeWords(e,t){let n=e.frame;if(!this.extremes){let[e,t]=[0,0];for(let r=3;r<n.packed.length;r+=4)n.packed[r]<n.packed[e+3]&&(e=r-3),n.packed[r]>n.packed[t+3]&&(t=r-3);this.extremes={low:e/4,high:t/4}}let r=(n,r)=>{let i=this.extremes[n];return{key:`extreme-${n}`,kind:`extreme`,text:r,at:n=>e.place(i,t.exaggeration,n)}};return[r(`low`,`min`),r(`high`,`max`)]}tell(e,t){if(this.times=this.times.filter(t=>e-t<1e3),this.tellTimer===null&&(this.times.length>0||e-this.lastTold<Z)&&(this.tellTimer=setTimeout(()=>{this.tellTimer=null,this.tell(performance.now(),h.getState())},Z)),e-this.lastTold<Z)return;this.lastTold=e;let[n,r]=this.range(t),i=this.rig.pixelsPerMeter,a=Me(130/i),o=this.latest,s={frame:o?.number??0,time:o?.time??0,fps:this.times.length,latency:this.latency,low:n,high:r,min:o?.min??0,max:o?.max??0,barLength:a,barPixels:a*i,diverged:o?.diverged??!1},c=m.getState();Object.keys(s).every(e=>s[e]===c[e])||m.setState(s)}ray(e,t){let n=this.renderer.domElement.getBoundingClientRect(),r=new S((e-n.left)/n.width*2-1,1-(t-n.top)/n.height*2);return this.raycaster.setFromCamera(r,this.rig.camera),this.raycaster.ray}hit(e,t){let n=this.surface,r=h.getState();return!n||n!==this.shownMesh()||r.appearance===`wireframe`?null:Ie(this.ray(e,t),this.drawnPositions(n,r),n.topology.triangles,e=>this.section.keeps(e))}drawnPositions(e,t){let n=`${e.topology.id} ${e.frame?.number} ${e.frame?.time} ${t.exaggeration}`;if(this.positions?.key===n)return this.positions.values;let r=e.topology.rest.length/3,i=new Float32Array(3*r),a=new w;for(let n=0;n<r;n++)e.place(n,t.exaggeration,a).toArray(i,3*n);return this.positions={key:n,values:i},i}hoverOver(e){this.hoverAt=e,e===null&&m.getState().hover?m.setState({hover:null}):e&&this.request()}hover(e,t){if(!this.hoverAt||this.grabs.holding||e-this.lastHover<$e)return;this.lastHover=e;let n=this.hit(this.hoverAt.x,this.hoverAt.y),r=this.surface?.frame;if(this.renderer.domElement.style.cursor=t.tape?`crosshair`:n?`grab`:``,!n||!r||t.coloring!==`field`){m.getState().hover&&m.setState({hover:null});return}let i=this.element.getBoundingClientRect();m.setState({hover:{x:this.hoverAt.x-i.left,y:this.hoverAt.y-i.top,vertex:n.vertex,value:a(r,n.vertex)}})}fit(){let e=this.shownMesh();e&&this.rig.fit(e.box(h.getState().exaggeration).clone()),this.request()}look(e){this.rig.look(e),this.request()}toggleSection(){if(h.getState().section!==`off`){f({section:`off`});return}let e=this.rig.toEye,t=Math.abs(e.x)>Math.abs(e.y)?`x`:`y`;f({section:t,sectionFlipped:e[t]<0,sectionAt:.5})}get drawn(){let e=this.shownMesh();return{frame:this.latest?.number??0,time:this.latest?.time??0,seq:this.lastSeq,latency:this.latency,triangles:e?.triangles??0,topology:e?.topology.id??0,fps:this.times.length}}vertexPosition(e){let t=this.surface?.frame;return t&&4*e<t.packed.length?r(t,e):null}screenOf(e){if(!this.surface)return null;let t=this.surface.place(e,h.getState().exaggeration).project(this.rig.camera),n=this.renderer.domElement.getBoundingClientRect();return[n.left+(t.x+1)/2*n.width,n.top+(1-t.y)/2*n.height]}still(e,t){let n=this.renderer.getPixelRatio();this.renderer.setPixelRatio(e),this.resizeNow(),this.renderer.render(this.scene,this.rig.camera);try{return t(this.renderer.domElement)}finally{this.renderer.setPixelRatio(n),this.resizeNow(),this.request()}}resizeNow(){let{clientWidth:e,clientHeight:t}=this.element;this.renderer.setSize(e,t),this.surface?.setPixels(this.renderer.domElement.height/2)}},nt=[[`front`,`Front view`,`1`],[`back`,`Back view`,`2`],[`left`,`Left view`,`3`],[`right`,`Right view`,`4`],[`top`,`Top view`,`5`],[`bottom`,`Bottom view`,`6`],[`corner`,`Corner view`,`7`]],Q=null;function $(){return Q||(Q=new tt,s(it(Q)),ae()),Q}function rt(e){f({[e]:!h.getState()[e]})}function it(e){let t=[[`edges`,`Voxel edges`,`e`],[`ghost`,`Undeformed ghost`,`g`],[`cavities`,`Look into the cavities`,`c`],[`symbols`,`Clamps, loads and probes`],[`extremes`,`Mark minimum and maximum`],[`grid`,`Ground grid`],[`orthographic`,`Orthographic view`,`o`],[`tape`,`Measuring tape`,`m`]];return[{id:`fit`,title:`Fit the body into the view`,group:`View`,keys:[`f`],run:()=>e.fit()},{id:`section`,title:`Section plane`,group:`View`,keys:[`x`],run:()=>e.toggleSection()},...nt.map(([t,n,r])=>({id:`look-${t}`,title:n,group:`View`,keys:[r],run:()=>e.look(t)})),...t.map(([e,t,n])=>({id:`view-${e}`,title:t,group:`View`,...n?{keys:[n]}:{},run:()=>rt(e)})),...[1,2,4].map(t=>({id:`picture-${t}`,title:`Save a picture${t>1?` at ${t} times the size`:``}`,group:`View`,run:()=>void p(e,t)}))]}export{$ as viewport};