import{i as e}from"./colormaps.js";import{D as t,F as n,I as r,L as i,N as a,T as o,_ as s,a as c,d as l,f as u,i as d,l as f,n as p,p as m,r as h,u as g,v as _,w as ee,x as v}from"./three.js";var y=`
in vec4 packed;
uniform vec3 uOrigin;
uniform vec3 uScale;
uniform float uExaggeration;
vec3 placed() {
  vec3 now = uOrigin + uScale * packed.xyz;
  return position + uExaggeration * (now - position);
}
`,b=`
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
`,x=`
uniform vec4 uPlane;
uniform float uSection;
bool cutAway(vec3 at) {
  return uSection > 0.5 && dot(uPlane.xyz, at) > uPlane.w;
}
`,S=`
${y}
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
`,C=`
precision highp float;
${x}
${b}
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
`,w=`
precision highp float;
${x}
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
`,T=`
precision highp float;
${x}
in vec3 vWorld;
out vec4 color;
void main() {
  if (cutAway(vWorld)) discard;
  color = vec4(0.0);
}
`,E=`
${y}
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
`,D=`
precision highp float;
${x}
${b}
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
`,O=`
out vec3 vWorld;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vWorld = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}
`,k=`
precision highp float;
uniform vec3 uCut;
out vec4 color;
void main() {
  // Hatched, as drawings mark cut material.
  float line = smoothstep(0.0, 1.2, abs(fract((gl_FragCoord.x - gl_FragCoord.y) / 11.0) - 0.5) * 11.0 - 0.2);
  color = vec4(uCut * mix(0.82, 1.0, line), 1.0);
}
`,A=`
out vec2 vAt;
void main() {
  vAt = position.xy * 0.5 + 0.5;
  gl_Position = vec4(position.xy, 1.0, 1.0);
}
`,te=`
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
`,j=`
precision highp float;
uniform sampler2D uPicture;
out vec4 color;
void main() {
  color = vec4(texelFetch(uPicture, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
}
`,M=`
out vec2 vAt;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vAt = world.xy;
  gl_Position = projectionMatrix * viewMatrix * world;
}
`,N=`
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
`,P=`#c77dd6`;function F(e,t){let n=new a({glslVersion:l,vertexShader:S,fragmentShader:w,side:2,transparent:!0,depthWrite:!1,polygonOffset:!0,polygonOffsetFactor:-1,polygonOffsetUnits:-1,uniforms:{...t,uOwn:{value:new c(P)}}}),r=new v(e,n);return r.renderOrder=3,r.frustumCulled=!1,r}function I(e,t,n){let r=r=>{let i=r===1?m:g,o=new a({glslVersion:l,vertexShader:t,fragmentShader:T,uniforms:n,side:r,colorWrite:!1,depthWrite:!1,depthTest:!1,stencilWrite:!0,stencilFunc:519,stencilFail:i,stencilZFail:i,stencilZPass:i}),s=new v(e,o);return s.renderOrder=0,s.frustumCulled=!1,s.visible=!1,s};return[r(1),r(0)]}var L=[`#56b4e9`,`#e78ac3`,`#2fc39b`,`#e8dd55`,`#b9a2f5`,`#e8704a`],R=128;function z(e,t){let n=new Uint32Array(256);for(let e of t)n[e]+=1;let r=[],i=new Uint32Array(256),a=0;for(let e=0;e<256;e++){let t=n[e];i[e]=a,t>0&&r.push({owner:e,start:3*a,count:3*t}),a+=t}let o=new Uint32Array(e.length);for(let n=0;n<t.length;n++){let r=3*i[t[n]]++;o[r]=e[3*n],o[r+1]=e[3*n+1],o[r+2]=e[3*n+2]}return{index:o,ranges:r}}var B=class{group=new u;topology;frame=null;triangles=0;attribute;shells=[];edges;ghost;geometries=[];rest;sheets=[];shared;lut;bounds=new p;constructor(t,i){this.topology=t;let a=t.rest.length/3,o=new h(t.rest,3);this.rest=o,this.attribute=new h(new Uint16Array(4*a),4,!0),this.attribute.setUsage(35048),this.lut=new f(e(`viridis`,0),256,1),this.lut.minFilter=this.lut.magFilter=_,this.lut.needsUpdate=!0,this.shared={uOrigin:{value:new r},uScale:{value:new r},uExaggeration:{value:0},uPlane:i.plane,uSection:i.section,uLut:{value:this.lut},uFrameRange:{value:new n(0,1)},uRange:{value:new n(0,1)}};let{index:s,ranges:c}=z(t.triangles,t.owners),l=new h(s,1);for(let e of c)this.shells.push(this.shell(o,l,e));this.edges=this.lines(o,this.shared),this.edges.renderOrder=4,this.ghost=this.lines(o,{...this.shared,uExaggeration:{value:0}}),this.ghost.renderOrder=3,this.group.add(this.edges,this.ghost)}geometry(e,t){let n=new d;return n.setAttribute(`position`,e),n.setAttribute(`packed`,this.attribute),n.setIndex(t),this.geometries.push(n),n}shell(e,t,n){let r=this.geometry(e,t);r.setDrawRange(n.start,n.count);let i=new a({glslVersion:l,vertexShader:S,fragmentShader:C,side:2,polygonOffset:!0,polygonOffsetFactor:1,polygonOffsetUnits:1,uniforms:{...this.shared,uByField:{value:1},uOwn:{value:new c(`#e8b88a`)},uAlpha:{value:1}}}),o=new v(r,i);o.renderOrder=2,o.frustumCulled=!1;let s=[...I(r,S,this.shared)];return this.group.add(o,...s),{owner:n.owner,mesh:o,stencils:s}}lines(e,t){let n=this.geometry(e,new h(this.topology.edges,1)),r=new a({glslVersion:l,vertexShader:E,fragmentShader:D,transparent:!0,depthWrite:!1,uniforms:{...t,uVoxelSize:{value:this.topology.voxelSize||1},uPixels:{value:1},uFade:{value:1},uByField:{value:0},uInk:{value:new i(0,0,0,.4)}}}),o=new s(n,r);return o.frustumCulled=!1,o}cover(e){if(!(this.sheets.length>0)){this.sheets=e.map(e=>{let t=new h(new Uint32Array(e.triangles),1);return F(this.geometry(this.rest,t),this.shared)});for(let e of this.sheets)this.group.add(e)}}suits(e){return e.topology===this.topology.id&&e.packed.length===this.attribute.array.length}setFrame(e){this.frame=e,this.attribute.array=e.packed,this.attribute.needsUpdate=!0,this.shared.uOrigin.value.fromArray(e.origin),this.shared.uScale.value.fromArray(e.scale),this.shared.uFrameRange.value.set(e.min,e.max)}setRange(e,t){this.shared.uRange.value.set(e,t)}setPixels(e){this.edges.material.uniforms.uPixels.value=e,this.ghost.material.uniforms.uPixels.value=e}lutKey=``;style(t,n,r){let i=`${t.colormap} ${t.bands}`;i!==this.lutKey&&(this.lutKey=i,this.lut.image.data.set(e(t.colormap,t.bands)),this.lut.minFilter=this.lut.magFilter=_,this.lut.needsUpdate=!0),this.shared.uExaggeration.value=this.frame?t.exaggeration:0;let a=t.appearance===`wireframe`,o=t.section!==`off`;this.triangles=0;for(let{owner:e,mesh:i,stencils:s}of this.shells){let c=(e&R)!==0,{uniforms:l}=i.material,u=t.cavities&&!c,d=!this.frame||this.frame.max<=this.frame.min,f=t.coloring===`field`&&!d&&!(t.cavities&&c);l.uByField.value=+!!f,l.uAlpha.value=u?.16:1;let p=c?t.cavities?L[(e&127)%L.length]:n.parts[0]??`#e8b88a`:n.parts[e]??`#e8b88a`;l.uOwn.value.set(p),i.material.transparent!==u&&(i.material.transparent=u,i.material.depthWrite=!u,i.material.needsUpdate=!0),i.renderOrder=u?5:2,i.visible=r&&!a,i.visible&&(this.triangles+=i.geometry.drawRange.count/3);for(let e of s)e.visible=i.visible&&o&&!this.topology.tets}let s=this.edges.material.uniforms.uInk.value;a?s.set(n.ink.r,n.ink.g,n.ink.b,.75):s.set(0,0,0,t.cavities?.12:.42),this.edges.material.uniforms.uFade.value=+!a;let c=!this.frame||this.frame.max<=this.frame.min;this.edges.material.uniforms.uByField.value=a&&t.coloring===`field`&&!c?1:0,this.edges.visible=r&&(a||t.edges);let l=this.ghost.material.uniforms;l.uInk.value.set(n.ink.r,n.ink.g,n.ink.b,.3),l.uFade.value=0,this.ghost.visible=r&&t.ghost;for(let e of this.sheets)e.visible=r&&t.symbols}box(e){if(!this.frame)return this.bounds.setFromArray(this.topology.rest);let t=new r().fromArray(this.frame.origin),n=t.clone().add(new r().fromArray(this.frame.scale));if(this.bounds.set(t,n),e!==1){this.bounds.makeEmpty();let t=new r,n=this.topology.rest.length/3;for(let r=0;r<n;r++)this.bounds.expandByPoint(this.place(r,e,t))}return this.bounds}place(e,t,n=new r){let{rest:i}=this.topology;n.set(i[3*e],i[3*e+1],i[3*e+2]);let a=this.frame;if(!a)return n;let o=a.packed,s=(n,r)=>r+t*(a.origin[n]+a.scale[n]*o[4*e+n]/65535-r);return n.set(s(0,n.x),s(1,n.y),s(2,n.z))}dispose(){this.lut.dispose();for(let e of this.geometries)e.dispose();for(let{mesh:e,stencils:t}of this.shells){e.material.dispose();for(let e of t)e.material.dispose()}this.edges.material.dispose(),this.ghost.material.dispose();for(let e of this.sheets)e.material.dispose()}},V=32,H=260,U=Math.PI/2-1e-4,W={front:[-Math.PI/2,0],back:[Math.PI/2,0],left:[Math.PI,0],right:[0,0],top:[-Math.PI/2,U],bottom:[-Math.PI/2,-U],corner:[-Math.PI/3.4,.42]},G=class{perspective=new o(V,1,.001,10);orthographic=new ee(-1,1,1,-1,-10,10);pose={target:new r,azimuth:0,elevation:0,distance:.3};flight=null;width=1;height=1;reach=.1;flat=!1;places=0;constructor(){[this.pose.azimuth,this.pose.elevation]=W.corner,this.perspective.up.set(0,0,1),this.orthographic.up.set(0,0,1),this.place()}get camera(){return this.flat?this.orthographic:this.perspective}get target(){return this.pose.target}get toEye(){return K(this.pose.azimuth,this.pose.elevation)}get orientation(){return this.camera.quaternion}get pixelsPerMeter(){return this.height/(2*this.pose.distance*Math.tan(V*Math.PI/360))}resize(e,t){this.width=e,this.height=t,this.place()}setReach(e){this.reach=e,this.place()}turn(e,t){this.flight=null,this.pose.azimuth-=e*.0075,this.pose.elevation=q(this.pose.elevation+t*.0075),this.place()}move(e,t){this.flight=null;let n=1/this.pixelsPerMeter,i=new r(1,0,0).applyQuaternion(this.orientation),a=new r(0,1,0).applyQuaternion(this.orientation);this.pose.target.addScaledVector(i,-e*n).addScaledVector(a,t*n),this.place()}zoom(e,t,n){this.flight=null;let i=this.pose.distance,a=Math.min(100,Math.max(1e-4,i*e)),o=1/this.pixelsPerMeter,s=new r(1,0,0).applyQuaternion(this.orientation),c=new r(0,1,0).applyQuaternion(this.orientation),l=s.multiplyScalar(t*this.width*o/2).addScaledVector(c,n*this.height*o/2);this.pose.target.addScaledVector(l,1-a/i),this.pose.distance=a,this.place()}look(e){let[t,n]=W[e];this.fly({...this.pose,target:this.pose.target.clone(),azimuth:t,elevation:n})}turnAbout(e){this.fly({...this.pose,target:e.clone()})}fit(e,t=!1){if(e.isEmpty())return;let n=Math.max(1e-5,e.getSize(new r).length()/2),i=Math.min(1,this.width/this.height),a=1.12*n/Math.sin(V*Math.PI/360)/i,o={...this.pose,target:e.getCenter(new r),distance:a};t?(this.flight=null,this.pose=o,this.place()):this.fly(o)}advance(e){if(!this.flight)return!1;let{from:t,to:n,start:r}=this.flight,i=Math.min(1,(e-r)/H),a=1-(1-i)**3;return this.pose={target:t.target.clone().lerp(n.target,a),azimuth:t.azimuth+J(t.azimuth,n.azimuth)*a,elevation:t.elevation+(n.elevation-t.elevation)*a,distance:t.distance*(n.distance/t.distance)**a},i===1&&(this.flight=null),this.place(),!0}fly(e){let t=matchMedia(`(prefers-reduced-motion: reduce)`).matches,n={...this.pose,target:this.pose.target.clone()};this.flight={from:n,to:e,start:t?-1/0:performance.now()}}place(){this.places+=1;let{target:e,distance:t}=this.pose,n=e.clone().addScaledVector(this.toEye,t),r=this.width/this.height,i=t+this.reach*12+.001;this.perspective.aspect=r,this.perspective.near=Math.max(t/200,t-this.reach*12),this.perspective.far=i;let a=t*Math.tan(V*Math.PI/360);this.orthographic.top=a,this.orthographic.bottom=-a,this.orthographic.left=-a*r,this.orthographic.right=a*r,this.orthographic.near=-i,this.orthographic.far=i;for(let t of[this.perspective,this.orthographic])t.position.copy(n),t.lookAt(e),t.updateProjectionMatrix(),t.updateMatrixWorld()}};function K(e,t){let n=Math.cos(t);return new r(n*Math.cos(e),n*Math.sin(e),Math.sin(t))}function q(e){return Math.min(U,Math.max(-U,e))}function J(e,t){let n=2*Math.PI;return((t-e+Math.PI)%n+n)%n-Math.PI}function Y(e){let t=getComputedStyle(document.documentElement).getPropertyValue(e).trim();return new c(t||`#888888`)}function X(e){if(!(e>0))return 1;let t=10**Math.floor(Math.log10(e)+1e-9),n=e/t;return(n>=5?5:n>=2?2:1)*t}var Z=class{mesh=new v(new t(2,2),new a({glslVersion:l,vertexShader:A,fragmentShader:te,depthTest:!1,depthWrite:!1,uniforms:{uTop:{value:Y(`--sky-top`)},uBottom:{value:Y(`--sky-bottom`)}}}));constructor(){this.mesh.frustumCulled=!1,this.mesh.renderOrder=-10}recolor(){this.mesh.material.uniforms.uTop.value=Y(`--sky-top`),this.mesh.material.uniforms.uBottom.value=Y(`--sky-bottom`)}},ne=class{cell=.01;mesh=new v(new t(1,1),new a({glslVersion:l,vertexShader:M,fragmentShader:N,transparent:!0,depthWrite:!1,side:2,uniforms:{uCell:{value:.01},uCenter:{value:new n},uReach:{value:1},uInk:{value:Y(`--grid`)},uFacing:{value:1}}}));constructor(){this.mesh.renderOrder=-5}recolor(){this.mesh.material.uniforms.uInk.value=Y(`--grid`)}lay(e){let t=e.getSize(new r),n=e.getCenter(new r),i=Math.max(t.x,t.y,t.z);this.cell=X(i/4);let{uCell:a,uCenter:o,uReach:s}=this.mesh.material.uniforms;a.value=this.cell,o.value.set(n.x,n.y),s.value=4.5*i,this.mesh.position.set(n.x,n.y,e.min.z-1e-4*i),this.mesh.scale.setScalar(9*i)}face(e){this.mesh.material.uniforms.uFacing.value=Math.min(1,Math.abs(e)/.12)}},Q=21,$=3,re=class{element=document.createElement(`div`);shown=new Map;point=new r;constructor(){this.element.className=`view-labels`}set(e){let t=new Set(this.shown.keys());for(let n of e){t.delete(n.key);let e=this.shown.get(n.key)?.element;e&&e instanceof HTMLButtonElement!=!!n.onClick&&(e.remove(),e=void 0),e||(e=document.createElement(n.onClick?`button`:`span`),e.className=`view-label ${n.kind}`,e instanceof HTMLButtonElement&&(e.type=`button`),e.dataset.testid=`label-${n.key}`,this.element.append(e)),e.textContent!==n.text&&(e.textContent=n.text),n.title&&(e.title=`${n.text}\n${n.title}`),n.color&&e.style.setProperty(`--mark`,n.color),e.onclick=n.onClick??null,this.shown.set(n.key,{label:n,element:e})}for(let e of t)this.shown.get(e)?.element.remove(),this.shown.delete(e)}place(e,t,n){let r=[];for(let{label:i,element:a}of this.shown.values()){let o=i.at(this.point).project(e),s=o.z>-1&&o.z<1&&Math.abs(o.x)<1.05&&Math.abs(o.y)<1.05;if(a.hidden=!s,!s)continue;let c=(o.x+1)/2*t,l=(1-o.y)/2*n,u=7*i.text.length+24,d=e=>!r.some(t=>Math.abs(t.y-l-Q*e)<20&&Math.abs(t.x-c)<(t.w+u)/2),f=0;for(;f<=$&&!d(f);)f++;let p=f>$&&i.kind===`probe`;p?f=0:r.push({x:c,y:l+Q*f,w:u}),a.classList.toggle(`crowded`,p),a.classList.toggle(`moved`,f>0),a.style.setProperty(`--lead`,`${Q*f}px`),a.style.transform=`translate(${Math.round(c)}px, ${Math.round(l+Q*f)}px)`}}};export{Y as a,L as c,k as d,O as f,X as i,I as l,A as m,ne as n,G as o,j as p,Z as r,B as s,re as t,P as u};